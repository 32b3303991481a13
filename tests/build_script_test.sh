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
