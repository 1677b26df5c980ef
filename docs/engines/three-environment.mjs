// Light that `rsibr export --for three` wrote: scene.environment = await loadCompressed("court.dds").
import * as THREE from "three";
import { DDSLoader } from "three/addons/loaders/DDSLoader.js";
import { read } from "three/addons/libs/ktx-parse.module.js";

function environment(faces, format, type) {
    const texture = new THREE.CompressedCubeTexture(faces, format, type);
    texture.minFilter = THREE.LinearMipmapLinearFilter;
    texture.isPMREMTexture = true;
    texture.needsUpdate = true;
    return texture;
}

// NAME.dds: BC6H, a byte a texel, for graphics cards with EXT_texture_compression_bptc, as of desktops
export async function loadCompressed(url) {
    const { image, format } = await new DDSLoader().loadAsync(url);
    return environment(image, format);
}

// NAME.ktx2: half floats, for all graphics cards
export async function loadUncompressed(url) {
    const { levels, pixelWidth } = read(new Uint8Array(await (await fetch(url)).arrayBuffer()));
    const faces = [0, 1, 2, 3, 4, 5].map((face) => {
        const mipmaps = levels.map(({ levelData }, mip) => {
            const width = pixelWidth >> mip, length = 4 * width * width;
            const data = new Uint16Array(levelData.slice().buffer, 2 * face * length, length);
            return { data, width, height: width };
        });
        return { mipmaps, width: pixelWidth, height: pixelWidth };
    });
    return environment(faces, THREE.RGBAFormat, THREE.HalfFloatType);
}
