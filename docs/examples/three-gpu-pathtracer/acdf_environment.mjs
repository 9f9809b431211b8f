// three-gpu-pathtracer with an .acdf file in place of the tables that it makes of the environment: the same picture, with
// as many samples. Written for three-gpu-pathtracer 0.0.26, whose shader it extends by two functions.
//
//   const file = reader.open(bytes);                       // of the same map: acdf env sky.hdr --filter bilinear
//   const pathTracer = new WebGLPathTracer(renderer);
//   const stop = drawEnvironmentFrom(pathTracer, file);    // stop() gives back what was there
//   pathTracer.setScene(scene, camera);                    // scene.environment stays the map itself
import {tablesTexture} from "acdf";
import {glsl} from "acdf/shaders";
import {DataTexture, RedIntegerFormat, UnsignedIntType} from "three";

// three's y is up, ours is z; azimuth runs the other way. Colours are looked up as before.
const functions = /* glsl */ `
    ${glsl}
    float acdfEquirect(vec3 direction, inout vec3 color) {
        color = sampleEquirectColor(envMapInfo.map, direction);
        return acdf_pdf(acdf_anywhere(), vec3(direction.x, -direction.z, direction.y));
    }
    float acdfEquirectProbability(vec2 r, inout vec3 color, inout vec3 direction) {
        vec4 s = acdf_sample(acdf_anywhere(), r);
        direction = vec3(s.x, s.z, -s.y);
        color = sampleEquirectColor(envMapInfo.map, direction);
        return s.w;
    }
    #define sampleEquirect acdfEquirect
    #define sampleEquirectProbability acdfEquirectProbability
`;
const AFTER = "float applyFilteredGlossy("; // the first function behind those that are replaced

function tablesOf(file) {
    const {width, height, data} = tablesTexture(file.shaderTables());
    const texture = new DataTexture(data, width, height, RedIntegerFormat, UnsignedIntType);
    texture.internalFormat = "R32UI";
    texture.needsUpdate = true;
    return texture;
}

/** Samples from `file` (an environment) instead of scene.environment's own tables. */
export function drawEnvironmentFrom(pathTracer, file) {
    const {material} = pathTracer._pathTracer, before = material.fragmentShader;
    if (!before.includes(AFTER)) throw new Error(`the path tracer's shader has no "${AFTER}"`);
    const texture = tablesOf(file);
    material.uniforms.acdf_tables = {value: texture};
    material.fragmentShader = before.replace(AFTER, () => functions + AFTER);
    material.needsUpdate = true;
    pathTracer.reset();
    return () => {
        material.fragmentShader = before;
        delete material.uniforms.acdf_tables;
        material.needsUpdate = true;
        texture.dispose();
        pathTracer.reset();
    };
}
