# The rows of parallax_search_table side by side: a line for each world, dimension and share of starts.
# Means; of the portfolio with its 95 % bootstrap interval, and its share of uniform with that of the ratio.
BEGIN { FS = " *\\| *" }
$5 == "strategy" || $2 ~ /^-+$/ { next }
NF < 8 { if ($0 != "") rest = rest $0 "\n"; next }
{
  key = $2 " | " $3 " | " $4
  if (!(key in seen)) { seen[key] = 1; keys[++n] = key }
  if (!($5 in column)) { column[$5] = 1; names[++m] = $5 }
  mean = $6; sub(/ .*/, "", mean)
  value[key, $5] = ($5 == "portfolio") ? $6 " | " $7 : mean
  if ($8 > 0) value[key, $5] = value[key, $5] "*"
}
END {
  line = "| world | d | p |"; rule = "|---|---|---|"
  for (i = 1; i <= m; ++i) {
    line = line " " names[i] (names[i] == "portfolio" ? " | of uniform" : "") " |"
    rule = rule "---|" (names[i] == "portfolio" ? "---|" : "")
  }
  print line; print rule
  for (k = 1; k <= n; ++k) {
    line = "| " keys[k] " |"
    for (i = 1; i <= m; ++i) line = line " " value[keys[k], names[i]] " |"
    print line
  }
  printf "\n%s", rest
}
