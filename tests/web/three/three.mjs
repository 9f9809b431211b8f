// The same scene by three-gpu-pathtracer with its own sampling of the environment and with ours: means, and variance at
// equal samples, from runs that do not depend on each other.
import {loadReader} from "acdf";
import * as THREE from "three";
import {WebGLPathTracer} from "three-gpu-pathtracer";

import {drawEnvironmentFrom} from "./acdf_environment.mjs";

const WIDTH = 32, HEIGHT = 24, RUNS = 64, SAMPLES = 4;
const send = answer => fetch("done", {method: "POST", body: answer});

// A portable float map as `acdf env` reads it: rows from the bottom up, which is how WebGL has them.
async function environmentOf(name) {
    const bytes = await (await fetch(name)).arrayBuffer(), text = new TextDecoder("latin1").decode(bytes.slice(0, 64));
    const [head, width, height] = /^PF\n(\d+) (\d+)\n-1\.0\n/.exec(text), rgb = new Float32Array(bytes.slice(head.length));
    const rgba = new Uint16Array(4 * width * height);
    for (let i = 0; i < width * height; ++i)
        for (let k = 0; k < 4; ++k) rgba[4 * i + k] = THREE.DataUtils.toHalfFloat(k < 3 ? rgb[3 * i + k] : 1);
    const texture = new THREE.DataTexture(rgba, Number(width), Number(height), THREE.RGBAFormat, THREE.HalfFloatType);
    texture.mapping = THREE.EquirectangularReflectionMapping;
    texture.minFilter = texture.magFilter = THREE.LinearFilter;
    texture.wrapS = THREE.RepeatWrapping;
    texture.needsUpdate = true;
    return texture;
}

function sceneWith(environment) {
    const scene = new THREE.Scene();
    scene.environment = environment;
    scene.background = new THREE.Color(0);
    const add = (geometry, material, x, y, z) => {
        const mesh = new THREE.Mesh(geometry, new THREE.MeshStandardMaterial(material));
        mesh.position.set(x, y, z);
        scene.add(mesh);
        return mesh;
    };
    add(new THREE.PlaneGeometry(12, 12), {color: 0xcccccc, roughness: 1}, 0, 0, 0).rotation.x = -Math.PI / 2;
    add(new THREE.SphereGeometry(1, 24, 12), {color: 0xcc8866, roughness: 1}, -1.1, 1, 0);
    add(new THREE.BoxGeometry(1.4, 1.4, 1.4), {color: 0x88aacc, roughness: 0.4}, 1.1, 0.7, 0.4);
    return scene;
}

// Sums over the pixels: of their means, and of the variance of a run.
async function measure(pathTracer, renderer) {
    const sum = new Float64Array(WIDTH * HEIGHT), squares = new Float64Array(WIDTH * HEIGHT);
    const pixels = new Float32Array(4 * WIDTH * HEIGHT);
    for (let run = 0; run < RUNS; ++run) {
        pathTracer.reset();
        pathTracer._pathTracer.material.seed = run * SAMPLES;
        while (pathTracer.samples < SAMPLES) {
            pathTracer.renderSample();
            await new Promise(resolve => setTimeout(resolve));
        }
        renderer.readRenderTargetPixels(pathTracer.target, 0, 0, WIDTH, HEIGHT, pixels);
        for (let i = 0; i < sum.length; ++i) {
            const light = 0.2126 * pixels[4 * i] + 0.7152 * pixels[4 * i + 1] + 0.0722 * pixels[4 * i + 2];
            sum[i] += light;
            squares[i] += light * light;
        }
    }
    let mean = 0, variance = 0;
    sum.forEach((s, i) => {
        mean += s / RUNS / sum.length;
        variance += (squares[i] - s * s / RUNS) / (RUNS - 1) / sum.length;
    });
    return {mean, variance, error: Math.sqrt(variance / RUNS / sum.length)};
}

async function run() {
    const renderer = new THREE.WebGLRenderer();
    renderer.setSize(WIDTH, HEIGHT, false);
    const pathTracer = new WebGLPathTracer(renderer);
    Object.assign(pathTracer, {bounces: 2, renderDelay: 0, minSamples: 0, fadeDuration: 0, rasterizeScene: false,
                               renderToCanvas: false, dynamicLowRes: false});
    // Independent numbers: its stratified ones start with the same strata after each reset, and short runs all miss the rest.
    pathTracer._pathTracer.material.setDefine("RANDOM_TYPE", 0);
    const camera = new THREE.PerspectiveCamera(40, WIDTH / HEIGHT, 0.1, 100);
    camera.position.set(0, 3, 7);
    camera.lookAt(0, 0.6, 0);
    const environment = await environmentOf("sky.pfm");
    pathTracer.setScene(sceneWith(environment), camera);
    const theirs = await measure(pathTracer, renderer);
    const file = (await loadReader()).open(await (await fetch("sky.acdf")).arrayBuffer());
    const stop = drawEnvironmentFrom(pathTracer, file), ours = await measure(pathTracer, renderer);
    stop();
    const {width, height} = environment.image, bytes = 2 * width * height + 2 * height;
    const result = {theirs, ours, ratio: ours.variance / theirs.variance, theirBytes: bytes,
                    ourBytes: file.shaderTables().byteLength};
    await fetch("result.json", {method: "POST", body: JSON.stringify(result)});
    const apart = Math.abs(ours.mean - theirs.mean), noise = Math.hypot(ours.error, theirs.error);
    if (!(theirs.mean > 0 && apart < 4 * noise + 0.002 * theirs.mean)) return `means differ: ${JSON.stringify(result)}`;
    if (!(result.ratio < 1.1)) return `ours is noisier: ${JSON.stringify(result)}`;
    return "ok";
}
run().catch(error => `failed: ${error.stack}`).then(send);
