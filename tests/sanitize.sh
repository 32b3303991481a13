#!/bin/bash
# sanitize.sh [--no-install] [fuzz|fast|threads ...]: what must hold under the sanitizers; without words all three. fuzz:
# each reader for a few thousand inputs under AddressSanitizer and UBSan; fast: the tests labelled fast under the same;
# threads: session, cache and workers under ThreadSanitizer. Of UBSan's checks (CMakePresets.json) those of every pointer
# that is followed (null, alignment, object-size, vptr, pointer-overflow) stay out: they make Eigen five times as slow, and
# what they would find AddressSanitizer mostly does.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
. cmake/build.sh
take_options "$@"
install_packages build test
export UBSAN_OPTIONS=print_stacktrace=1 ASAN_OPTIONS=handle_sigill=1 TSAN_OPTIONS=suppressions=$PWD/tests/tsan_suppressions.txt

# sanitized PRESET TARGET CHOICE...: builds the targets under a preset and runs what the options of ctest choose.
sanitized() {
  build "$1" $2
  ctest --test-dir "build-$1" --output-on-failure -j "$(nproc)" "${@:3}"
}

for what in "${ARGUMENTS[@]:-fuzz fast threads}"; do
  for one in $what; do
    case $one in
      fuzz) sanitized asan fuzz_readers -L fuzz ;;
      fast) sanitized asan fast_tests -L '^fast$' ;;
      threads) sanitized tsan threads_tests -L '^threads$' ;;
      *) echo "sanitize.sh: there is no '$one': fuzz, fast or threads" >&2; exit 2 ;;
    esac
  done
done
