# Turns the plain comments of a header into Doxygen's: lines of them document what follows, those behind a declaration that
# declaration, the first block the file. Text is taken literally; lines indented by three spaces after an empty one are code.
BEGIN { first = 1 }
function literal(text) {
  gsub(/[\\@<>#%&*`$]/, "\\\\&", text)
  return text
}
NR == 1 && /^\/\/ SPDX-License-Identifier:/ { first = 2; next }
NR == first && /^\/\// { print "/// \\file" }
match($0, /^[ \t]*\/\/ ?/) {
  indent = $0
  sub(/\/\/.*/, "", indent)
  text = substr($0, RLENGTH + 1)
  empty = text ~ /^[ \t]*$/
  code = text ~ /^  / && (after_empty || in_code) || empty && in_code
  in_code = code
  after_empty = empty
  print indent "/// " (code ? "    " text : literal(text))
  next
}
{ in_code = after_empty = 0 }
match($0, /[;,)}] *\/\/ /) && $0 !~ /\/\/.*"[;)]/ {
  print substr($0, 1, RSTART) " ///< " literal(substr($0, RSTART + RLENGTH))
  next
}
{ print }
