# Every single mistake of the axioms about effects and preconditions of a model. The input is the
# canonical text, one axiom a line; -v out=FOLDER gets I.e, the model with mistake I, and I.txt,
# "KIND: axiom". Prints how many there are.

function emit(kind, at, text,   i) {
  if (text == line[at] || (at, text) in made) return
  made[at, text] = 1
  for (i = 1; i <= n; ++i) {
    if (i != at) print line[i] > (out "/" count ".e")
    else if (text != "") print text > (out "/" count ".e")
  }
  close(out "/" count ".e")
  print kind ": " line[at] > (out "/" count ".txt")
  close(out "/" count ".txt")
  ++count
}
function axiom(q, c, e) { return q (c == "" ? "" : "(" c ") -> ") e "." }
function without(parts, k, j, other,   i, text, part) {  # the jth replaced, or left out
  for (i = 1; i <= k; ++i) {
    part = i == j ? other : parts[i]
    if (part != "") text = text (text == "" ? "" : " & ") part
  }
  return text
}
# Conjuncts at depth 0.
function split_and(text, parts,   i, c, depth, k, at) {
  k = 0; at = 1; depth = 0
  for (i = 1; i <= length(text); ++i) {
    c = substr(text, i, 1)
    if (c == "(" || c == "{") ++depth
    if (c == ")" || c == "}") --depth
    if (depth == 0 && substr(text, i, 3) == " & ") { parts[++k] = substr(text, at, i - at); at = i + 3 }
  }
  parts[++k] = substr(text, at)
  return k
}
# Terms of a fluent over the variables of the quantifier; empty: it has others.
function term(f, q,   name, i, k, sorts, text) {
  name = f; sub(/\(.*/, "", name)
  text = f; sub(/^[^(]*\(/, "", text); sub(/\)$/, "", text)
  k = split(text, sorts, ",")
  text = ""
  for (i = 1; i <= k; ++i) {
    if (q !~ ("[[,]" sorts[i] "1[],]")) return ""
    text = text (i > 1 ? "," : "") sorts[i] "1"
  }
  return name "(" text ")"
}
# The variables of a sort that has two in the axiom, exchanged.
function swapped(text) {
  gsub(/1/, "#", text); gsub(/2/, "1", text); gsub(/#/, "2", text); gsub(/time2/, "time1", text)
  return text
}
# Are all its numbered variables those of the quantifier?
function bound(text, q,   name) {
  while (match(text, /[a-z_]+[12]/)) {
    name = substr(text, RSTART, RLENGTH)
    if (q !~ ("[[,]" name "[],]")) return 0
    text = substr(text, RSTART + RLENGTH)
  }
  return 1
}
{ line[++n] = $0 }
/^fluent / { fluents[++f] = substr($0, 8) }
/^noninertial / { derived[substr($0, 13)] = 1 }
END {
  count = 0
  for (at = 1; at <= n; ++at) {
    text = line[at]
    if (text ~ /Happens\(/ && text ~ / -> / && text !~ /(Initiates|Terminates|Releases)\(/)
      emit("precondition forgotten", at, "")
    if (text !~ /(Initiates|Terminates|Releases)\([^-]*\.$/) continue
    q = ""; rest = text
    if (match(rest, /^\[[^]]*\] /)) { q = substr(rest, 1, RLENGTH); rest = substr(rest, RLENGTH + 1) }
    c = ""; e = rest
    if (match(rest, / -> (Initiates|Terminates|Releases)/)) {
      c = substr(rest, 1, RSTART - 1); e = substr(rest, RSTART + 4)
      k = split_and(c, parts)
      if (k == 1 && c ~ /^\(/ && c ~ /\)$/) c = substr(c, 2, length(c) - 2)
    }
    sub(/\.$/, "", e)
    emit(e ~ /^Releases/ ? "release forgotten" : "axiom dropped", at, "")
    k = c == "" ? 0 : split_and(c, parts)
    for (j = 1; j <= k; ++j) emit("condition dropped", at, axiom(q, without(parts, k, j, ""), e))
    other = e
    if (sub(/^Initiates/, "Terminates", other) || sub(/^Terminates/, "Initiates", other))
      emit("sign flipped", at, axiom(q, c, other))
    if (e ~ /1/ && e ~ /2/ && bound(swapped(e), q)) emit("argument swapped", at, axiom(q, c, swapped(e)))
    if (q ~ /2/) {
      for (j = 1; j <= k; ++j) {
        if (parts[j] !~ /^!?HoldsAt/ || !bound(swapped(parts[j]), q)) continue
        emit("argument swapped", at, axiom(q, without(parts, k, j, swapped(parts[j])), e))
      }
    }
    name = e; sub(/^[^(]*\(/, "", name); sub(/\),.*/, ")", name)
    fluent = substr(e, index(e, name) + length(name) + 1); sub(/,time1\)$/, "", fluent)
    kind = e; sub(/\(.*/, "", kind)
    for (i = 1; i <= f; ++i) {
      symbol = fluents[i]; sub(/\(.*/, "", symbol)
      if (symbol in derived) continue
      text = term(fluents[i], q)
      if (text == "" || text == fluent) continue
      if (index(fluent, symbol "(") != 1)
        emit("effect on the wrong fluent", at, axiom(q, c, kind "(" name "," text ",time1)"))
      emit("condition added", at, axiom(q, (c == "" ? "" : c " & ") "HoldsAt(" text ",time1)", e))
    }
  }
  print count
}
