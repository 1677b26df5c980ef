#!/bin/bash
# Draws figures of the papers with rsibr on the path: figures.sh [SECTION ...], all sections by default.
# CAYMAN names Cornell's measurement cayman.brdf; TEAPOT a teapot in Wavefront OBJ, in whose place Suzanne sits
set -euo pipefail
docs=$(cd "$(dirname "$0")" && pwd)
images=$docs/images
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

sheet() { # PICTURE COLUMNS STOPS PREVIEW.exr ...
    python "$docs/../.ci/contact_sheet.py" "$images/$1.png" "${@:2}"
}

# Kautz, Daubert & Seidel 2004; docs/mip-chains.md shows and explains them
kautz2004() {
    bake() { # NAME SIZE OPTIONS
        rsibr bake mip-chain --environment courtyard --size "$2" "${@:3}" -o "$1.rsibr.exr"
    }
    draw() { # NAME.exr MAP-SET OPTIONS
        rsibr preview "$2.rsibr.exr" --size 128 --fill 0.9 "${@:3}" -o "$1.exr"
    }
    monkey=(--mesh monkey --view 0.4,-1,0.25 --perspective 30 --background light)
    bake box 64 --filter box
    # Figure 3: materials from one chain, by f and b
    draw bunny box "${monkey[@]}" --kd 0.5,0.35,0.2 --f0 0.05 --mip 2.3
    draw bust box "${monkey[@]}" --kd 0.3 --f0 0.24 --mip 1.5
    draw paint box "${monkey[@]}" --kd 0.5,0.02,0.02 --f0 0.15 --mip 0.2
    draw rubber box "${monkey[@]}" --kd 0.03 --f0 0.15 --mip 3.3
    sheet kautz2004-3 4 0 {bunny,bust,paint,rubber}.exr
    # Figure 4: the border problem at b = 9.4, and without it
    bake large 512 --filter box
    bake bordered 512 --filter bordered
    ball=(--f0 1 --mip 9.4 --view 1,-1,0.8)
    draw clamped large "${ball[@]}" --borders clamped
    draw seamless large "${ball[@]}"
    draw across bordered "${ball[@]}"
    sheet kautz2004-4 3 0 {clamped,seamless,across}.exr
    # Figure 5: Phong's N = 225, as before the paper, and the box filter's mip that is as blurred
    bake phong 64 --filter phong --exponents 225
    glossy=(--kd 0.2 --f0 0.6)
    draw phong phong "${monkey[@]}" "${glossy[@]}" --mip 0
    draw box225 box "${monkey[@]}" "${glossy[@]}" --exponent 225
    draw b225 box "${monkey[@]}" "${glossy[@]}" --mip 2.25
    sheet kautz2004-5 3 0 {phong,box225,b225}.exr
    # Figure 6: f from left to right, b from top to bottom
    grid=()
    for b in 0 0.8 1.7 2.4; do
        for f in 0.03 0.09 0.26 0.42; do
            draw "grid-$b-$f" box "${monkey[@]}" --kd 0.4,0.25,0.1 --f0 $f --mip $b
            grid+=("grid-$b-$f.exr")
        done
    done
    sheet kautz2004-6 4 0 "${grid[@]}"
}

# Miller & Hoffman 1984; docs/reflection-tables.md shows and explains them
miller1984() {
    bake() { # NAME OPTIONS
        rsibr bake reflection-tables --environment interior "${@:2}" -o "$1.rsibr.exr"
    }
    draw() { # NAME.exr MAP-SET OPTIONS
        rsibr preview "$2.rsibr.exr" --size 128 --fill 0.9 "${@:3}" -o "$1.exr"
    }
    monkey=(--mesh monkey --view 0.4,-1,0.25 --perspective 30 --background light)
    # Section 6: a mirror, which is the illumination map itself; Phong of falling exponents; Lambert
    bake mirror --specular mirror:
    bake lambert --diffuse lambert:kd=0.8
    balls=(mirror)
    for n in 200 50 10; do
        bake phong$n --specular phong:n=$n,ks=1
        balls+=("phong$n")
    done
    balls+=(lambert)
    for ball in "${balls[@]}"; do
        draw "ball-$ball" "$ball" --background light
        draw "monkey-$ball" "$ball" "${monkey[@]}"
    done
    drawn=("${balls[@]/#/ball-}" "${balls[@]/#/monkey-}")
    sheet miller1984-6 5 -1.3 "${drawn[@]/%/.exr}"
    # Section 6.2's varnish and section 7's weights, by one set of tables
    bake varnished --material varnished-wood
    draw wood varnished "${monkey[@]}" --coat none
    draw varnish varnished "${monkey[@]}"
    draw thick varnished "${monkey[@]}" --coat constant:k=0.5
    draw curve varnished "${monkey[@]}" --coat none --weights curve:wd=0:0/1:1,ws=0:3/0.4:0.5/1:0
    sheet miller1984-7 4 0 {wood,varnish,thick,curve}.exr
    # Section 9: light sent back, and light let through
    bake cats-eye --material cats-eye
    bake glass --material glass
    draw eye cats-eye "${monkey[@]}"
    draw glass glass "${monkey[@]}"
    draw refracted glass "${monkey[@]}" --tables refraction
    sheet miller1984-9 3 -1 {eye,glass,refracted}.exr
    # What light from beneath the horizon does, and a fade
    bake glossy --specular phong:n=5,ks=1
    draw paper glossy --background light
    draw faded glossy --background light --fade
    sheet miller1984-horizon 2 -1.3 {paper,faded}.exr
}

# A painted table, which stays in its world, and a matcap, which turns with the eye; docs/reflection-tables.md
painted() {
    for turn in 0 40 80; do
        python "$docs/../.ci/painting.py" "painting-$turn.exr" "$turn"
        rsibr bake reflection-tables --environment "painting-$turn.exr" --specular mirror:ks=0.9 \
            --diffuse lambert:kd=0.1 -o "painted-$turn.rsibr.exr"
        view=$(python -c "from math import *; a = radians($turn); print(f'{sin(a)},{-cos(a)},0.25')")
        for table in painted matcap; do
            turned=0
            [ $table = painted ] || turned=$turn
            rsibr preview "painted-$turned.rsibr.exr" --mesh monkey --view "$view" --size 128 --fill 0.9 \
                --perspective 30 -o "$table-$turn.exr"
        done
    done
    sheet painted 3 0 {painted,matcap}-{0,40,80}.exr
}

# Kautz & McCool 2000; docs/lobe-stacks.md shows and explains them
ward=ward:alpha=0.04,ks=0.8
copper=he_torrance:sigma=0.2,tau=2.5,metal=copper
cayman=cornell:path=$(realpath "${CAYMAN:-cayman.brdf}")
printed=(--cosine outside)
pot=(--mesh "$([ -z "${TEAPOT:-}" ] && echo monkey || realpath "$TEAPOT")" --view 0.5,-1,0.6 --size 384)
stack() { # NAME MODEL OPTIONS
    rsibr bake lobe-stack --environment interior --brdf "$2" "${@:3}" -o "$1.rsibr.exr"
}
# Figure 7: errors of the three methods, and of a joint fit
kautz2000-7() {
    rsibr fit --brdf $ward --method single "${printed[@]}" -o "single lobe.json"
    rsibr fit --brdf $ward --method single-2d "${printed[@]}" -o "single 2D lobe.json"
    rsibr fit --brdf $ward --method greedy "${printed[@]}" -o "three lobes.json"
    rsibr fit --brdf $ward --plot plots --beside {three\ lobes,single\ lobe,single\ 2D\ lobe}.json -o "joint fit.json"
    cp plots/error.svg "$images/kautz2000-7.svg"
}
# Figure 8: the single lobe's maps, from grazing to the normal; Cayman above, copper below
kautz2000-8() {
    maps=()
    for name in cayman copper; do
        stack $name "${!name}" --method single "${printed[@]}" --size 128
        rsibr report $name.rsibr.exr --maps $name-maps
        maps+=($name-maps/lobe00.slice0{01,03,06,10,15}.exr)
    done
    sheet kautz2000-8 5 1 "${maps[@]}"
}
# Each pixel filtered with the model itself, the paper's methods, and a joint fit
beside() { # PICTURE MODEL METHOD ...
    stack joint "$2"
    rsibr preview joint.rsibr.exr "${pot[@]}" --exact "$2" -o exact.exr
    for method in "${@:3}"; do
        stack "$method" "$2" --method "$method" "${printed[@]}"
    done
    for method in "${@:3}" joint; do
        rsibr preview "$method.rsibr.exr" "${pot[@]}" -o "$method.exr"
    done
    drawn=(exact "${@:3}" joint)
    sheet "$1" ${#drawn[@]} 0 "${drawn[@]/%/.exr}"
    python "$docs/../.ci/picture_errors.py" "${drawn[@]/%/.exr}"
}
# Figures 9 to 11, 12 to 14 and 15 to 18
kautz2000-9() { beside kautz2000-9 "$cayman" single single-2d; }
kautz2000-12() { beside kautz2000-12 $copper single single-2d; }
kautz2000-15() { beside kautz2000-15 $ward greedy single single-2d; }

# The web page, as Chromium shows it; docs/web-page.md
web-page() {
    rsibr bake kernel-pyramid --environment forest -o light.rsibr.exr
    rsibr export light.rsibr.exr --mesh monkey --view 0.1,-1,0.1 --base-color 1,0.58,0.4 --metallic 1 \
        --roughness 0.55 --background light --background-blur 10 --view-transform AgX -o page.html
    cat >> page.html <<'EOS'
<script>
const asked = setInterval(() => {
    const box = document.querySelector("[name=beside]");
    if (box) { clearInterval(asked); box.click(); }
}, 100);
</script>
EOS
    chromium --headless --no-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader --hide-scrollbars \
        --blink-settings=preferredColorScheme=0 --window-size=1060,560 --virtual-time-budget=60000 \
        --screenshot="$images/web-page.png" "file://$PWD/page.html"
}

sections=("$@")
[ $# -gt 0 ] || sections=(kautz2004 miller1984 painted kautz2000-{7,12,15,8,9} web-page)
for section in "${sections[@]}"; do
    mkdir "$work/$section"
    (set -e; cd "$work/$section"; "$section")
done
