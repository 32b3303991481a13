# awk -f bands.awk README.md: the table of figures of `--style child` as an SVG, dots over the band of real children.

function trim(text) { gsub(/^ +| +$/, "", text); return text }
function text(x, y, anchor, color, words) {
  printf "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\" fill=\"%s\">%s</text>\n", x, y, anchor, color, words
}
function largest(a, b) { return a > b ? a : b }

BEGIN {
  FS = "|"; left = 350; width = 520; high = 46; first = 62
  children = "#9fc5e8"; plain = "#6b7580"; styled = "#d2691e"; ink = "#20262d"
}
/^\| gestures of the eight adults/ { inside = 1; title = trim($2); next }
inside && !/^\|/ { inside = 0 }
inside && !/^\|---/ {
  name[++rows] = trim($2); was[rows] = trim($3); is[rows] = trim($4); real[rows] = trim($5)
}

END {
  if (rows == 0) { print "bands.awk: no table of figures" > "/dev/stderr"; exit 1 }
  printf "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 910 %d\" ", first + rows * high
  print "font-family=\"Inter, Helvetica, Arial, sans-serif\" font-size=\"14\">"
  print "<rect width=\"100%\" height=\"100%\" fill=\"#fdfdfd\"/>"
  text(18, 30, "start", ink, title)
  printf "<circle cx=\"%d\" cy=\"25\" r=\"6\" fill=\"#fdfdfd\" stroke=\"%s\" stroke-width=\"2\"/>\n", left + 46, plain
  text(left + 59, 30, "start", ink, "as they are")
  printf "<circle cx=\"%d\" cy=\"25\" r=\"7\" fill=\"%s\"/>\n", left + 165, styled
  text(left + 178, 30, "start", ink, "--style child")
  printf "<rect x=\"%d\" y=\"16\" width=\"34\" height=\"18\" rx=\"3\" fill=\"%s\"/>\n", left + 292, children
  text(left + 334, 30, "start", ink, "seven children, their median")
  for (i = 1; i <= rows; i++) draw(i, first + (i - 1) * high)
  print "</svg>"
}

function draw(i, y,    parts, low, top, most, scale) {
  split(real[i], parts, "(")
  low = parts[2] + 0
  split(parts[2], parts, " to ")
  top = parts[2] + 0
  most = 1.08 * largest(largest(was[i] + 0, is[i] + 0), top)
  scale = width / most
  text(18, y + 17, "start", ink, name[i])
  printf "<line x1=\"%d\" y1=\"%d\" x2=\"%d\" y2=\"%d\" stroke=\"#d8dde2\"/>\n", left, y + 12, left + width, y + 12
  printf "<rect x=\"%.1f\" y=\"%d\" width=\"%.1f\" height=\"20\" rx=\"3\" fill=\"%s\"/>\n", left + scale * low, y + 2, scale * (top - low), children
  printf "<rect x=\"%.1f\" y=\"%d\" width=\"3\" height=\"20\" fill=\"#2f6da8\"/>\n", left + scale * (real[i] + 0) - 1.5, y + 2
  printf "<circle cx=\"%.1f\" cy=\"%d\" r=\"6\" fill=\"#fdfdfd\" stroke=\"%s\" stroke-width=\"2\"/>\n", left + scale * (was[i] + 0), y + 12, plain
  printf "<circle cx=\"%.1f\" cy=\"%d\" r=\"7\" fill=\"%s\"/>\n", left + scale * (is[i] + 0), y + 12, styled
  label(left + scale * (was[i] + 0), y + 38, was[i], plain, scale * (is[i] - was[i]))
  label(left + scale * (is[i] + 0), y + 38, is[i], styled, scale * (was[i] - is[i]))
}

# away: how far to the right the other dot is.
function label(x, y, words, color, away) {
  if (away > 80 || away < -80) return text(x, y, "middle", color, words)
  if (away > 0) return text(x + 6, y, "end", color, words)
  text(x - 6, y, "start", color, words)
}
