#!/bin/bash
# Draws the pictures of docs/mip-chains.md, with rsibr on the path
set -euo pipefail
images=$(realpath "$(dirname "$0")")/images
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

draw() { # MAP-SET PICTURE PREVIEW-OPTIONS
    rsibr preview "$1.rsibr.exr" "${@:3}" -o "$images/mips-$2.png" --force
}

for filter in box bordered ggx; do
    rsibr bake mip-chain --environment courtyard --filter $filter -o $filter.rsibr.exr
done
for bias in 4.5 9.4; do
    ball=(--f0 1 --mip $bias --view 1,-1,0.8 --size 144)
    draw box box-clamped-$bias "${ball[@]}" --borders clamped
    draw box box-$bias "${ball[@]}"
    draw bordered bordered-$bias "${ball[@]}"
done
for roughness in 0 0.25 0.5; do
    draw ggx monkey-$roughness --mesh monkey --f0 0.15 --kd 0.4,0.05,0.03 --roughness $roughness \
        --view 0.4,-1,0.25 --size 144
done
