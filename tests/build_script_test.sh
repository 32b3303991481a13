#!/bin/bash
# cmake/build.sh: installs exactly what is missing, and nothing when told not to or when all is there.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
fake=$(mktemp -d)
trap 'rm -rf "$fake"' EXIT
# Stand-ins: every wanted package but clang is there; apt-get and sudo only write down what they are asked for.
cat >"$fake/dpkg-query" <<'EOF'
#!/bin/bash
for name in "${@:3}"; do [ "$name" = "${MISSING:-}" ] || echo "$name installed"; done
EOF
printf '#!/bin/bash\necho "$@" >>"%s/asked"\n' "$fake" >"$fake/apt-get"
printf '#!/bin/bash\nexec "$@"\n' >"$fake/sudo"
printf '#!/bin/bash\n' >"$fake/node"
chmod +x "$fake"/*
export PATH="$fake:$PATH"

MISSING= bash -c '. cmake/build.sh; install_packages build test'
[ ! -e "$fake/asked" ] || { echo "installs although all is there"; exit 1; }

MISSING=clang bash -c '. cmake/build.sh; take_options --no-install retarget; install_packages build' 2>"$fake/said" && {
  echo "goes on without a package"
  exit 1
}
grep -q 'missing.*clang' "$fake/said" || { echo "does not name the package"; exit 1; }
[ ! -e "$fake/asked" ] || { echo "installs although told not to"; exit 1; }

MISSING=clang bash -c '. cmake/build.sh; take_options; install_packages build' | grep -q 'Installing 1 .*clang'
grep -q 'install .* clang$' "$fake/asked" || { echo "does not install the package"; exit 1; }
! grep -q ninja-build "$fake/asked" || { echo "installs what is there"; exit 1; }

rm "$fake/asked"
MISSING=nodejs bash -c '. cmake/build.sh; take_options; install_packages build test'
[ ! -e "$fake/asked" ] || { echo "installs a package although its program is there"; exit 1; }

# Building: STRICT=ON reaches the configuration of every preset, of one that was configured before, too. The caller's
# own STRICT is not what is tested.
unset STRICT
tree=$(mktemp -d) root=$PWD
trap 'rm -rf "$fake" "$tree"' EXIT
printf '#!/bin/bash\necho "$@" >>"%s/cmake_asked"\n' "$fake" >"$fake/cmake"
chmod +x "$fake/cmake"
mkdir "$tree/build-asan"
touch "$tree/build-asan/build.ninja"
(cd "$tree" && STRICT=ON bash -c ". $root/cmake/build.sh; build asan fast_tests" >/dev/null)
grep -q -- '--preset asan.* -DSTRICT=ON' "$fake/cmake_asked" || { echo "warnings stay warnings"; exit 1; }
grep -qx -- '--build build-asan -- fast_tests' "$fake/cmake_asked" || { echo "builds something else"; exit 1; }
rm "$fake/cmake_asked"
(cd "$tree" && bash -c ". $root/cmake/build.sh; build asan" >/dev/null)
! grep -q -- '--preset' "$fake/cmake_asked" || { echo "configures what is configured"; exit 1; }

# The npm packages: a stand-in npm that fails leaves a sentence for the tests; one that works is asked once.
copy=$(mktemp -d)
trap 'rm -rf "$fake" "$tree" "$copy"' EXIT
cp -r --parents cmake/build.sh tests/interop/package.json tests/interop/package-lock.json "$copy"
cd "$copy"
printf '#!/bin/bash\necho npm error code ENOTFOUND >&2\necho npm error no such host >&2\nexit 1\n' >"$fake/npm"
chmod +x "$fake/npm"
bash -c '. cmake/build.sh; take_options; install_node_packages' >/dev/null 2>&1
grep -q 'could not install.*no such host' build/interop/missing.txt || { echo "does not say why npm failed"; exit 1; }
printf '#!/bin/bash\necho "$@" >>"%s/npm_asked"\n' "$fake" >"$fake/npm"
for _ in 1 2; do bash -c '. cmake/build.sh; take_options; install_node_packages' >/dev/null; done
[ "$(wc -l <"$fake/npm_asked")" = 1 ] || { echo "installs npm packages that are there"; exit 1; }
[ ! -e build/interop/missing.txt ] || { echo "still says that npm packages are missing"; exit 1; }
rm build/interop/installed
bash -c '. cmake/build.sh; take_options --no-install; install_node_packages' 2>"$fake/said" && {
  echo "goes on without npm packages"
  exit 1
}
grep -q 'npm packages.*missing' "$fake/said" || { echo "does not name the npm packages"; exit 1; }
! grep -qE 'resolved|https?:' tests/interop/package-lock.json || { echo "the lock file names addresses"; exit 1; }
