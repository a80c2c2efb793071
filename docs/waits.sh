#!/usr/bin/env bash
# Measures how long one waits for this crate: fresh builds, and builds after a
# one-line change. Prints the tables of CONTRIBUTING.md.
#
#   docs/waits.sh              # everything, about ten minutes on two cores
#   docs/waits.sh --release    # only the program, fresh
#
# It works on a copy of the last commit, in a folder of its own, and does not
# touch the checkout or its target folder. Packages are downloaded beforehand.
set -euo pipefail
cd "$(dirname "$0")/.."

copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
git archive HEAD | tar -x -C "$copy"
cd "$copy"
export CARGO_TARGET_DIR="$copy/target"
cargo fetch --locked --quiet

# wait NAME COMMAND…: a row with the seconds that a command takes.
wait_for() {
    local name=$1 start=$EPOCHREALTIME
    shift
    "$@" >"$copy/log" 2>&1 || { cat "$copy/log" >&2; exit 1; }
    awk -v name="$name" -v from="$start" -v to="$EPOCHREALTIME" \
        'BEGIN { printf "| %s | %.0f s |\n", name, to - from }'
}

# change FILE: another line in its first function.
change() {
    awk '!done && /^    (    )?let / { print "std::hint::black_box(0_u8);"; done = 1 } { print }' \
        "$1" >"$copy/changed"
    cp "$copy/changed" "$1"
}

# units COUNT: the longest units of the last `cargo … --timings`.
units() {
    printf '\n| unit | seconds |\n|---|---|\n'
    awk -F'"' '
        /^const UNIT_DATA/ { inside = 1 }
        /^\]/ { inside = 0 }
        !inside { next }
        $2 == "name" { name = $4 }
        $2 == "target" { target = $4 }
        $2 == "duration" {
            gsub(/[^0-9.]/, "", $3)
            printf "%08.1f\t%s%s\n", $3, name, target
        }' "$CARGO_TARGET_DIR/cargo-timings/cargo-timing.html" |
        sort -r |
        awk -F'\t' -v most="$1" 'NR <= most { printf "| %s | %.1f |\n", $2, $1 }'
}

printf '| what | wait |\n|---|---|\n'
wait_for 'fresh `cargo run --release`, to its result' cargo run --locked --release --timings
fresh=$(units 12)
if [ "${1:-}" = --release ]; then
    echo "$fresh"
    exit
fi
rm -rf "$CARGO_TARGET_DIR"
wait_for 'fresh `cargo test --release --no-run`' cargo test --locked --release --no-run --timings
tests=$(units 16)
wait_for 'the tests themselves' cargo test --locked --release
change src/cli/run.rs
wait_for '`cargo test --release --no-run` after a line in the program' cargo test --locked --release --no-run
change src/engine/event_driven/search.rs
wait_for '`cargo test --release --no-run` after a line in an engine' cargo test --locked --release --no-run
printf '\nUnits of the fresh program:\n%s\n\nUnits of the fresh tests:\n%s\n' "$fresh" "$tests"
