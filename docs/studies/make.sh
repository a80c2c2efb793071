#!/usr/bin/env bash
# Makes the studies behind docs/accuracy.md: their reports, their pictures,
# and the parts of the page that are taken from the reports; and the table of
# docs/textbook.md.
#
#   docs/studies/make.sh             # all, about a quarter of an hour on two cores
#   docs/studies/make.sh --quick     # with the stress suite a hundred times smaller
#
# Interrupted, it goes on where it was. To begin again, remove target/studies.
set -euo pipefail
cd "$(dirname "$0")/../.."

results=target/studies
mkdir -p "$results"
cargo build --locked --release
carom=target/release/carom

# study NAME KIND ARGUMENT…: one study; its report and pictures go to docs/.
study() {
    local name=$1 kind=$2
    shift 2
    echo "== $name: carom study $kind $*"
    "$carom" study "$kind" "$@" --output "$results/$name" >/dev/null
    cp "$results/$name/report.txt" "docs/studies/$name.txt"
    for picture in "$results/$name"/*.svg; do
        cp "$picture" "docs/images/$name-$(basename "$picture")"
    done
}

study throw error docs/studies/throw.toml
study box error docs/studies/box.toml
study fluid error hard-sphere-fluid
# docs/methods.md: where the method is a choice.
study few-collisions error docs/studies/few-collisions.toml --times 1 --dt 0.5,0.25,0.1,0.05
for scene in dense masses arcs pile; do
    study "$scene" error "docs/studies/$scene.toml"
done
study predictability precision docs/studies/predictability.toml
study bounces precision bouncing-ball
study stability stability "$@"
study scaling-stepped scaling rough-gas
study scaling-event-driven scaling hard-sphere-fluid

# Between `<!-- NAME: START -->` and `<!-- end -->` comes that part of the report
# which begins with a line that starts with START, up to the next empty line.
awk '
    /^<!-- end -->$/ { skipping = 0 }
    !skipping { print }
    /^<!-- [a-z-]+: .* -->$/ {
        name = $2
        sub(/:$/, "", name)
        start = $0
        sub(/^<!-- [a-z-]+: /, "", start)
        sub(/ -->$/, "", start)
        file = "docs/studies/" name ".txt"
        found = 0
        print "```text"
        while ((getline line < file) > 0) {
            if (!found && index(line, start) == 1) found = 1
            else if (found && line == "") break
            if (found) print line
        }
        close(file)
        print "```"
        if (!found) {
            print "docs/accuracy.md: no line of " file " starts with: " start > "/dev/stderr"
            failed = 1
        }
        skipping = 1
    }
    END { exit failed }
' docs/accuracy.md >"$results/accuracy.md"
mv "$results/accuracy.md" docs/accuracy.md

# The table between `<!-- textbook -->` and `<!-- end -->`.
cargo run --locked --release --example textbook >"$results/textbook.txt"
awk -v table="$results/textbook.txt" '
    /^<!-- end -->$/ { skipping = 0 }
    !skipping { print }
    /^<!-- textbook -->$/ {
        while ((getline line < table) > 0) print line
        skipping = 1
    }
' docs/textbook.md >"$results/textbook.md"
mv "$results/textbook.md" docs/textbook.md
