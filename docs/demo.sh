#!/bin/bash
# The main job from start to end, with plain rsibr commands: demo.sh FOLDER
set -euo pipefail
folder=${1:-demo}
mkdir -p "$folder"
cd "$folder"
: >errors.txt

for material in copper plastic; do
    rsibr capture --environment forest --material "$material" --views 12 --size 256 --samples 16 --denoise \
        -o "$material.rsibr.exr" --force
    rsibr info "$material.rsibr.exr"
    for mesh in monkey sphere; do
        rsibr preview "$material.rsibr.exr" --mesh "$mesh" --view 0.3,-1,0.3 --size 256 --turntable 24 \
            -o "$material-$mesh.png" --force
    done
    rsibr compare "$material.rsibr.exr" --views 3 --samples 64 -o "$material-compare" --force >>errors.txt
done

echo
echo "Pictures in $PWD:"
echo "  copper-monkey.png, plastic-monkey.png and their .mp4: a turn around Suzanne"
echo "  copper-sphere.png, plastic-sphere.png and their .mp4: a turn around the sphere"
echo "  copper-compare/index.html, plastic-compare/index.html: previews beside Cycles' own pictures, and the errors:"
sed 's/^/    /' errors.txt
