# Shared by run, test and .ci/run: installs missing packages, configures when needed, builds. Source it from the root.

# install_packages KIND...: installs the packages of those kinds that are missing; says so; nothing when all are there.
install_packages() {
  local kinds="$*" wanted=() missing=() installed kind name program
  while read -r kind name program; do
    [ -n "$program" ] && command -v "$program" >/dev/null && continue
    case " $kinds " in *" $kind "*) wanted+=("$name") ;; esac
  done < <(grep -v '^#' cmake/packages.txt)
  installed=$(dpkg-query -W -f='${Package} ${db:Status-Status}\n' "${wanted[@]}" 2>/dev/null || true)
  for name in "${wanted[@]}"; do
    grep -qx "$name installed" <<<"$installed" || missing+=("$name")
  done
  [ ${#missing[@]} -eq 0 ] && return 0
  if [ "${NO_INSTALL:-0}" = 1 ]; then
    echo "These Debian packages are missing and --no-install forbids installing them: ${missing[*]}" >&2
    exit 1
  fi
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "Install these packages as root first: ${missing[*]}" >&2; exit 1; }
    as_root=(sudo)
  fi
  mkdir -p build
  echo "Installing ${#missing[@]} Debian packages: ${missing[*]}"
  "${as_root[@]}" apt-get update -qq || echo "apt-get update failed; trying with the lists that are here" >&2
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "${missing[@]}" >build/install.log 2>&1 || {
    tail -5 build/install.log >&2
    echo "apt-get could not install the packages; build/install.log has the whole story." >&2
    exit 1
  }
}

# install_node_packages: what tests/interop runs, in exactly the versions of its lock file, into build/interop. Where npm
# cannot, it says why, there too, for the tests that need it; they fail then.
install_node_packages() {
  local from=tests/interop to=build/interop why
  cmp -s "$from/package-lock.json" "$to/installed" && return 0
  if [ "${NO_INSTALL:-0}" = 1 ]; then
    echo "The npm packages of $from/package.json are missing and --no-install forbids installing them." >&2
    exit 1
  fi
  mkdir -p "$to"
  echo "Installing the npm packages of $from"
  rm -f "$to/installed"
  cp "$from/package.json" "$from/package-lock.json" "$to/"
  if npm ci --prefix "$to" --ignore-scripts --no-audit --no-fund --fetch-retries=1 >build/npm.log 2>&1; then
    cp "$from/package-lock.json" "$to/installed"
    rm -f "$to/missing.txt"
  else
    why=$(sed -n 's/^npm \(error\|ERR!\) //p' build/npm.log | grep -vE '^(code|errno|syscall|network *$)' | head -1)
    echo "npm could not install the packages of $from: ${why:-see build/npm.log}" | tee "$to/missing.txt" >&2
  fi
}

# build PRESET [TARGET...]: configures the preset when it never was, then builds; with STRICT=ON in the environment
# warnings are errors. Quiet when nothing is to do.
build() {
  local preset=$1 folder=build-$1 launcher=()
  shift
  [ "$preset" = release ] && folder=build
  if command -v ccache >/dev/null; then  # what one checkout compiled serves another
    launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
    export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1
  fi
  if [ ! -f $folder/build.ninja ] || [ -n "${STRICT:-}" ]; then
    echo "Configuring ($folder/)"
    mkdir -p $folder
    cmake --preset "$preset" -DSTRICT="${STRICT:-OFF}" "${launcher[@]}" >$folder/configure.log 2>&1 || {
      cat $folder/configure.log >&2
      rm -f $folder/build.ninja
      exit 1
    }
  fi
  echo "Building"
  cmake --build $folder -- "$@" || { echo "The build failed." >&2; exit 1; }
}

# take_options ARGUMENT...: understands --no-install in first place; leaves the others in ARGUMENTS.
take_options() {
  NO_INSTALL=0
  if [ "${1:-}" = "--no-install" ]; then
    NO_INSTALL=1
    shift
  fi
  ARGUMENTS=("$@")
}
