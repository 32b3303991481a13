#!/bin/bash
# package_test.sh [BUILD]: makes the Debian package of a build folder and installs it, with what it says it depends on
# and nothing else, into a clean root that mmdebstrap makes from this machine's own apt sources. There the program must
# run as a plain user, from any place: the demo, the doctor, a script of the studio, a study for browsers, the man page.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
build=$(readlink -f "${1:-build}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

rm -f "$build"/understudy_*.deb
(cmake --build "$build" --target understudy_all man_page && cd "$build" && cpack) >"$work/package.log" 2>&1 ||
  { tail -20 "$work/package.log"; exit 1; }
cp "$build"/understudy_*.deb "$work/understudy.deb"

cat >"$work/script.us" <<'EOF'
open samples/scan samples/target_adult.glb
wait_frames 10
screenshot installed.png
EOF
cat >"$work/check.sh" <<'EOF'
set -eux
cd /tmp/user
understudy doctor
understudy play script.us --out out
understudy demo --out out
understudy study new --preset dong --out a.study
mkdir clips
for clip in $(understudy study trials a.study --format csv | grep -o 'clips/[0-9a-f]*\.mp4'); do echo film >"$clip"; done
understudy study web a.study --clips . --out web
test -s web/index.html
for made in installed.png target_adult.glb target_adult.png target_child.json; do test -s out/$made; done
zcat /usr/share/man/man1/understudy.1.gz | grep -q '^.SH "understudy retarget"'
test -s /usr/share/applications/understudy.desktop
test -s /usr/share/mime/packages/understudy.xml
test -s /usr/share/icons/hicolor/scalable/apps/understudy.svg
EOF
sources=(/etc/apt/sources.list /etc/apt/sources.list.d/*)
for source in "${sources[@]}"; do [ -s "$source" ] && existing+=("$source"); done
. /etc/os-release
in_root() { printf '%s' "--customize-hook=chroot \"\$1\" $*"; }
mmdebstrap --variant=apt --format=null --quiet \
  --customize-hook="mkdir -p \"\$1/tmp/user\"" \
  --customize-hook="copy-in $work/understudy.deb $work/script.us $work/check.sh /tmp/user" \
  "$(in_root apt-get install -y -qq --no-install-recommends /tmp/user/understudy.deb)" \
  "$(in_root chown -R nobody /tmp/user)" \
  "$(in_root setpriv --reuid=nobody --regid=nogroup --clear-groups env -i PATH=/usr/bin:/bin HOME=/tmp/user sh /tmp/user/check.sh)" \
  "$VERSION_CODENAME" /dev/null "${existing[@]}" >"$work/root.log" 2>&1 ||
  { tail -40 "$work/root.log"; echo "The package does not run in a clean root."; exit 1; }
grep -E '^(result|program|OpenGL|weights) ' "$work/root.log"
echo "The package runs with what it depends on alone."
