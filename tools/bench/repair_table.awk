# Tables from the lines of tools/bench/repair: set, number, kind, loop, outcome, simulations,
# milliseconds, reason, axiom. A mutant has one line if it is equivalent, else one for each loop.

function median(list,   values, n, i, j, x) {
  n = split(list, values, " ")
  if (n == 0) return "-"
  for (i = 2; i <= n; ++i) {
    x = values[i] + 0
    for (j = i - 1; j >= 1 && values[j] + 0 > x; --j) values[j + 1] = values[j]
    values[j + 1] = x
  }
  return n % 2 ? values[(n + 1) / 2] : (values[n / 2] + values[n / 2 + 1]) / 2
}
function share(part, whole) { return whole ? sprintf("%d (%d %%)", part, int(100 * part / whole)) : "" }
function row(key,   judged, ms) {
  judged = total[key] - same[key] - unseen[key]
  ms = median(times[key])
  printf "| %s | %d | %d | %d | %d | %s | %s | %d | %s | %s |\n", key, total[key], same[key], unseen[key], judged,
    share(first[key], judged), share(three[key], judged), none[key], median(runs[key]),
    ms == "-" ? "-" : sprintf(ms < 1000 ? "%.2f s" : "%.1f s", ms / 1000)
}
function count(keys, k, outcome, simulations, ms,   i, key) {
  for (i = 1; i <= k; ++i) {
    key = keys[i]
    if (!(key in total)) { order[++m] = key; total[key] = 0 }
    ++total[key]
    if (outcome == "equivalent") ++same[key]
    else if (outcome == "unseen") ++unseen[key]
    else {
      if (outcome == "first") ++first[key]
      if (outcome == "first" || outcome == "three") ++three[key]
      if (outcome == "none") ++none[key]
      runs[key] = runs[key] " " simulations
      times[key] = times[key] " " ms
    }
  }
}
BEGIN { FS = "\t" }
{ lines[++all] = $0; at[$1, $2, $4] = all; if (!(($1, $2) in known)) { known[$1, $2] = 1; mutants[++any] = $1 FS $2 } }
END {
  for (i = 1; i <= any; ++i) {
    split(mutants[i], id, FS)
    # The loop that tells; the open one comes first.
    how = ((id[1], id[2], "-") in at) ? "-" : "open-loop"
    if (how != "-") {
      split(lines[at[id[1], id[2], how]], field, FS)
      if (field[5] == "unseen" && (id[1], id[2], "closed-loop") in at) how = "closed-loop"
    }
    split(lines[at[id[1], id[2], how]], field, FS)
    k = split(field[1] FS field[3] FS "all", keys, FS)
    count(keys, k, field[5], field[6], field[7])
    split("open-loop closed-loop", loops, " ")
    for (j = 1; j <= 2; ++j) {
      if (!((id[1], id[2], loops[j]) in at)) continue
      split(lines[at[id[1], id[2], loops[j]]], field, FS)
      keys[1] = "in " loops[j]
      count(keys, 1, field[5], field[6], field[7])
    }
  }
  print "| | mutants | equivalent | no run tells | judged | the first proposal | the first three | no proposal | simulations | time |"
  print "|---|---|---|---|---|---|---|---|---|---|"
  for (i = 1; i <= m; ++i) if (order[i] != "all" && order[i] !~ /^in /) row(order[i])
  for (i = 1; i <= m; ++i) if (order[i] ~ /^in /) row(order[i])
  if (m) row("all")
  print "\nNo run tells:"
  for (i = 1; i <= any; ++i) {
    split(mutants[i], id, FS)
    if ((id[1], id[2], "-") in at) continue
    closed = (id[1], id[2], "closed-loop") in at ? at[id[1], id[2], "closed-loop"] : at[id[1], id[2], "open-loop"]
    split(lines[closed], field, FS)
    split(lines[at[id[1], id[2], "open-loop"]], opened, FS)
    if (field[5] == "unseen" && opened[5] == "unseen")
      print "  " field[1] " " field[2] ", " field[3] ": open loop: " opened[8] "; closed loop: " field[8] ": " field[9]
  }
  print "\nMissed:"
  for (i = 1; i <= all; ++i) {
    split(lines[i], field, FS)
    if (field[5] ~ /^(missed|none|three)$/) print "  " field[1] " " field[2] ", " field[3] ", " field[4] ": " field[5] " (" field[8] "): " field[9]
  }
}
