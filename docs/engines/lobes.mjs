// Lobes that `rsibr export --for lobes` wrote: useLobes(material, await loadLobes("court")) for each material.
import * as THREE from "three";
import { read } from "three/addons/libs/ktx-parse.module.js";

async function load(url) {
    const { levels, pixelWidth, pixelHeight, layerCount } = read(new Uint8Array(await (await fetch(url)).arrayBuffer()));
    const texels = new Uint16Array(levels[0].levelData.slice().buffer);
    const texture = layerCount > 1
        ? new THREE.DataArrayTexture(texels, pixelWidth, pixelHeight, layerCount)
        : new THREE.DataTexture(texels, pixelWidth, pixelHeight);
    texture.type = THREE.HalfFloatType;
    texture.minFilter = texture.magFilter = THREE.LinearFilter;
    texture.needsUpdate = true;
    return texture;
}

export async function loadLobes(name) {
    const [light, lobes] = await Promise.all([load(`${name}.ktx2`), load(`${name}-lobes.ktx2`)]);
    const shader = await (await fetch(`${name}.glsl`)).text();
    return { shader, uniforms: { rsibr_light: { value: light }, rsibr_lobes: { value: lobes } } };
}

// In the place of scene.environment; what lamps and the material itself add stays
export function useLobes(material, { shader, uniforms }) {
    material.onBeforeCompile = (program) => {
        Object.assign(program.uniforms, uniforms);
        program.fragmentShader = shader + program.fragmentShader.replace("#include <opaque_fragment>", `
            outgoingLight += rsibr_shade(diffuseColor.rgb, metalnessFactor, roughnessFactor,
                inverseTransformDirection(normal, viewMatrix), inverseTransformDirection(geometryViewDir, viewMatrix));
            #include <opaque_fragment>`);
    };
}
