# Makes the tables of docs/internals/performance.md of what parallax_rare_table prints: a line for each method, world
# and number of dimensions, and for each probability how often the interval holds, the median ratio
# of its ends, and the share of estimates that say that they are not resolved.
function trim(text) { gsub(/^ +| +$/, "", text); return text }
BEGIN { FS = "|" }
NF > 10 && trim($5) + 0 > 0 {
  method = trim($2); line = trim($3) " | " trim($4); p = trim($5)
  if (!(method in seen)) { methods[++method_count] = method; seen[method] = 1 }
  if (!(line in known)) { lines[++line_count] = line; known[line] = 1 }
  if (!(p in listed)) { probabilities[++p_count] = p; listed[p] = 1 }
  refused = trim($9) + 0
  cell[method, line, p] = trim($6) ", " trim($7) (refused > 0 ? " (" int(refused + 0.5) " %)" : "")
}
END {
  for (m = 1; m <= method_count; ++m) {
    head = "| " methods[m] " | d"; rule = "|---|---"
    for (k = 1; k <= p_count; ++k) { head = head " | p = " probabilities[k]; rule = rule "|---" }
    print head " |"; print rule "|"
    for (i = 1; i <= line_count; ++i) {
      row = "| " lines[i]
      for (k = 1; k <= p_count; ++k) row = row " | " cell[methods[m], lines[i], probabilities[k]]
      print row " |"
    }
    print ""
  }
}
