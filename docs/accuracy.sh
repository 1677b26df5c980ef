#!/bin/bash
# Measures the table in docs/accuracy.md, in about half an hour of a core: accuracy.sh FOLDER
set -euo pipefail
folder=${1:-accuracy}
mkdir -p "$folder"
cd "$folder"

for environment in forest city; do
    for material in mirror copper plastic car-paint; do
        name=$environment-$material
        rsibr capture --environment "$environment" --material "$material" --views 42 --size 128 --samples 32 --denoise \
            -o "$name.rsibr.exr" --force
        rsibr compare "$name.rsibr.exr" --views 30 --captured-views 12 --captured-views 42 --size 96 --samples 32 \
            -o "$name" --force
    done
done
