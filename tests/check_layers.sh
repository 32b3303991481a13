#!/bin/bash
# Fails when a file includes what its folder's row in layers.txt does not allow, or changes the environment where threads
# may run: whoever reads it meanwhile may crash.
# check_layers.sh [ROOT [TABLE]]: the tree to check, by default the one that this script is in.
set -euo pipefail
here=$(dirname "$(readlink -f "$0")")
cd "${1:-$here/..}"
folders=()
for folder in retarget render ui app; do [ -d $folder ] && folders+=("$folder"); done
# main() prepares the environment before anything else; the first window is made before the studio has its threads.
changes=$(grep -rnE --include='*.hpp' --include='*.cpp' '\<(setenv|unsetenv|putenv|clearenv|prepare_environment) *\(' \
  "${folders[@]}" | grep -vE '^(app/main\.cpp|retarget/networks/networks\.[ch]pp|render/context/glfw\.cpp):' || true)
[ -z "$changes" ] || { echo "$changes"; echo "The environment is changed where threads may run."; exit 1; }
grep -rnE --include='*.hpp' --include='*.cpp' '^ *#include *[<"]' "${folders[@]}" | awk -v table="${2:-$here/layers.txt}" '
  function row(path) {  # the longest folder of the table that the path lies in, "" if none
    while (sub("/[^/]*$", "", path)) if (path in floor) return path
    return ""
  }
  function library(path) {
    if (path ~ /^(torch|ATen|c10)\//) return "torch"
    if (path ~ /^imgui/) return "imgui"
    if (path ~ /^(GL|EGL|GLES[0-9]*|GLFW)\//) return "gl"
    return ""
  }
  function refused(from, path,    to, ours, tree) {  # why a file of folder from may not include the path, "" when it may
    if (library(path) != "" && !((from, library(path)) in also)) return "may not include " library(path)
    to = row(path)
    ours = path ~ /^(retarget|render|ui|app)\//
    if (to == "") return ours ? "includes a folder without a row in the table" : ""
    if (to == from) return ""
    if (floor[to] >= floor[from]) return "is on floor " floor[from] ", " to " on floor " floor[to]
    tree = to
    sub("/.*", "", tree)
    if (ours && index(from "/", tree "/") != 1 && !((from, to) in also)) {
      if (!((from, tree) in also)) return "may not include " tree
      if (also[from, tree] != "" && floor[to] > also[from, tree])
        return "reaches no higher than floor " also[from, tree] " of " tree
    }
    if ((to, "torch") in also && !((from, "torch") in also)) return "is free of LibTorch, " to " is not"
    return ""
  }
  BEGIN {
    while ((getline line < table) > 0) {
      if (line ~ /^#/ || line ~ /^ *$/) continue
      n = split(line, word, " ")
      floor[word[1]] = word[2] + 0
      for (i = 3; i <= n; ++i) {
        split(word[i], part, ":")
        also[word[1], part[1]] = part[2]
      }
    }
  }
  {
    file = $0
    sub(":.*", "", file)
    path = $0
    sub("^[^<\"]*[<\"]", "", path)
    sub("[>\"].*", "", path)
    from = row(file)
    why = from == "" ? "has no row in the table" : refused(from, path)
    if (why != "") { print file " includes " path ": " (from == "" ? "its folder" : from) " " why; bad = 1 }
  }
  END { if (!bad) print "Layers are clean."; exit bad }'
