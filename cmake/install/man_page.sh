#!/bin/bash
# man_page.sh PROGRAM PAGE.gz: understudy(1), from what --help of the program and of each of its subcommands says.
set -euo pipefail
program=$1 page=$2

# options_of: from a help text on stdin its options, arguments and subcommands, one .TP each.
options_of() {
  sed 's/\\/\\\\/g; s/-/\\-/g' | awk '
    function text(line) { return line ~ /^[.\47]/ ? "\\&" line : line }  # no request of troff
    /^(Options|Positionals|Subcommands):$/ { listed = 1; next }
    /^[^ ]/ || /^$/ { listed = 0; next }
    !listed { next }
    /^  [^ ]/ {  # "  NAME      what it is": two spaces part them, or the line has the name alone
      line = substr($0, 3)
      at = match(line, /  +/)
      print ".TP\n.B \"" (at ? substr(line, 1, at - 1) : line) "\""
      if (at) print text(substr(line, at + RLENGTH))
      next
    }
    { sub(/^ +/, ""); print text($0) }'
}

{
  echo ".TH UNDERSTUDY 1 \"\" \"understudy\" \"User Commands\""
  echo ".SH NAME"
  echo "understudy \\- lets any body perform any captured motion"
  echo ".SH SYNOPSIS"
  echo ".B understudy"
  echo ".I SUBCOMMAND"
  echo "[OPTIONS]"
  echo ".SH SUBCOMMANDS"
  "$program" --help | options_of
  for name in $("$program" --help | sed '1,/^Subcommands:/d' | awk '/^  [^ ]/ { print $1 }'); do
    echo ".SH \"understudy ${name//-/\\-}\""
    "$program" "$name" --help | sed -n '1p' | sed 's/-/\\-/g'
    "$program" "$name" --help | options_of
  done
  echo ".SH FILES"
  echo ".TP"
  echo ".B ~/.config/understudy/settings.json"
  echo "settings of the studio"
  echo ".TP"
  echo ".B ~/.local/state/understudy"
  echo "unsaved work, offered after a crash"
} | gzip -9n >"$page"
