#!/bin/bash
# Measures the table in docs/accuracy.md, in about half an hour of two cores, and those in docs/captured-lobes.md, in
# another half: accuracy.sh FOLDER
set -euo pipefail
ci=$(dirname "$(realpath "$0")")/../.ci
folder=${1:-accuracy}
mkdir -p "$folder"
cd "$folder"

measure() { # ENVIRONMENT MATERIAL CAPTURE-OPTIONS
    name=$1-$2
    rsibr bake radiance-views --environment "$1" --material "$2" --views 42 "${@:3}" -o "$name.rsibr.exr" --force
    rsibr compare "$name.rsibr.exr" --views 30 --captured-views 12 --captured-views 42 --size 96 --samples 32 -o "$name" --force
}

for environment in forest city; do
    measure $environment mirror --size 256 --samples 16 --no-denoise
    measure $environment copper --size 128 --samples 32 --denoise
    measure $environment plastic --size 128 --samples 32 --denoise
    measure $environment car-paint --size 256 --samples 32 --denoise
done

python "$ci/accuracy_table.py" {forest,city}-{mirror,copper,plastic,car-paint}
python "$ci/bench_captures.py" captures
python "$ci/bench_next_views.py" next-views
python "$ci/bench_relit.py" relit
