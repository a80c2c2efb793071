#!/usr/bin/env bash
# Makes the pictures of docs/batches.md: 100,000 breaks of a rack, whose cue ball is aimed at
# random, and how often what comes of them.
#
#   docs/studies/breaks.sh             # half a minute on two cores, after the build
set -euo pipefail
cd "$(dirname "$0")/../.."

results=target/studies
mkdir -p "$results"
cargo build --locked --release
carom=target/release/carom

"$carom" batch docs/studies/breaks.toml --count 100000 \
    --vary 'spheres[0].velocity[1]=normal(0,0.02)' --observe 'x[0],y[0]' \
    --output "$results/breaks.csv"
"$carom" plot "$results/breaks.csv" --histogram --columns 'pairs,x[0]' \
    --output docs/images/breaks.svg
