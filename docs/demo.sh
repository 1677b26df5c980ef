#!/bin/bash
# The main job from start to end, and each of the four systems once, with plain rsibr commands: demo.sh FOLDER
set -euo pipefail
docs=$(cd "$(dirname "$0")" && pwd)
folder=${1:-demo}
mkdir -p "$folder"
cd "$folder"
: >errors.txt
log=$PWD/demo.log
: >"$log"
exec 3>&2
[ -t 2 ] || exec 2>>"$log" # a bar is for a terminal

# One line for each step; what it prints, and what Blender says, into the log: step WHAT COMMAND ...
step() {
    echo "$1"
    shift
    if ! "$@" >>"$log"; then
        tail -n 20 "$log" >&3
        echo "The demo stopped at: $*. All that was said: $log" >&3
        exit 1
    fi
}

ours() {
    rsibr "$@" --log "$log"
}

compare() {
    ours compare "$@" | tee -a errors.txt
}

echo "This takes about three minutes on two cores."
# Cabral, Olano & Nemec 1999: what Cycles sees of a material, turned and held against Cycles
for material in copper plastic; do
    step "Capturing $material" \
        ours bake radiance-views --environment forest --material "$material" --views 12 --size 256 --samples 16 --denoise \
        -o "$material.rsibr.exr" --force
    step "Reading what $material.rsibr.exr holds" ours info "$material.rsibr.exr"
    step "Turning Suzanne in $material" \
        ours preview "$material.rsibr.exr" --mesh monkey --view 0.3,-1,0.3 --size 256 --turntable 24 \
        -o "$material-monkey.png" --force
    step "Comparing $material with Cycles" compare "$material.rsibr.exr" --views 3 --samples 64 -o "$material-compare" --force
done

# Kautz & McCool 2000: a BRDF as three lobes, held against the BRDF itself
step "Baking copper as three lobes" \
    ours bake lobe-stack --environment forest --brdf ggx:alpha=0.3,metal=copper --lobes 3 -o lobes.rsibr.exr --force
step "Comparing the lobes with the BRDF" compare lobes.rsibr.exr --views 2 -o lobes-compare --force
step "Reporting on the lobes" ours report lobes.rsibr.exr -o lobes.html --force

# Miller & Hoffman 1984 and Kautz, Daubert & Seidel 2004
step "Baking reflection tables of varnish" \
    ours bake reflection-tables --environment forest --material varnished-wood -o tables.rsibr.exr --force
step "Filtering the environment's mip chain" \
    ours bake mip-chain --environment forest --size 128 -o mips.rsibr.exr --force
step "Exporting it" ours export mips.rsibr.exr -o mips.ktx2 --up y --force

# Beyond them: light filtered once, for any material that is chosen afterwards
step "Filtering the environment with a bank of kernels" \
    ours bake kernel-bank --environment forest -o bank.rsibr.exr --force

for mesh in monkey sphere; do
    for map_set in plastic lobes tables mips bank; do
        case $map_set in
            mips) look=(--kd 0.05,0.2,0.1 --f0 0.08 --roughness 0.2) ;;
            bank) look=(--brdf ggx:alpha=0.15,metal=gold) ;;
            *) look=() ;;
        esac
        step "Drawing a $mesh from $map_set.rsibr.exr" \
            ours preview "$map_set.rsibr.exr" --mesh "$mesh" --view 0.3,-1,0.3 --size 256 "${look[@]}" \
            -o "$map_set-$mesh.exr" --force
    done
done
step "Putting the pictures on one sheet" python "$docs/../.ci/contact_sheet.py" systems.png 5 -1.3 {plastic,lobes,tables,mips,bank}-monkey.exr \
    {plastic,lobes,tables,mips,bank}-sphere.exr
step "Writing copper as a web page" ours export lobes.rsibr.exr --mesh monkey --view 0.3,-1,0.3 -o look.html --force

echo
echo "Pictures in $PWD:"
echo "  systems.png: captured plastic, copper from lobes, varnish from reflection tables, a glossy green from mips,"
echo "  gold from a kernel bank; mips.ktx2 is the mip chain for engines"
echo "  copper-monkey.png, plastic-monkey.png and their .mp4: a turn around Suzanne; what is pale on the plastic is the sky"
echo "  between trees"
echo "  lobes.html: all of a map set on one page"
echo "  look.html: copper on Suzanne, to be turned in a browser"
echo "  copper-compare/index.html, plastic-compare/index.html: previews beside Cycles' own pictures, and the errors;"
echo "  lobes-compare/index.html: beside the BRDF itself:"
sed 's/^/    /' errors.txt
echo "What Blender said: $log"
