// The packed file, installed: each call beside the program, every golden file, and files that are none.
import assert from "node:assert/strict";
import {readdirSync, readFileSync} from "node:fs";
import {test} from "node:test";

import {AcdfError, createTablesBuffer, loadReader, tablesTexture, TABLES_WIDTH} from "acdf";
import {glsl, wgsl} from "acdf/shaders";

const reader = await loadReader();
const goldenBytes = name => readFileSync(`${process.env.GOLDEN}/${name}`);
const golden = readdirSync(process.env.GOLDEN)
    .filter(name => name.endsWith(".acdf") && goldenBytes(name).includes("HALV")); // of curves there is no reader

// Columns u0 u1 x y z pdf of `acdf sample`, whose digits give back each float.
function samplesOf(csv) {
    const rows = readFileSync(csv, "utf8").trim().split("\n").slice(1).map(line => line.split(",").map(Number));
    return {u: rows.flatMap(row => row.slice(0, 2)), sampled: Float32Array.from(rows.flatMap(row => row.slice(2)))};
}

function directionsOf(sampled) {
    return sampled.filter((_, i) => i % 4 !== 3);
}
const densitiesOf = sampled => sampled.filter((_, i) => i % 4 === 3);

for (const [name, options] of [["sky", {}], ["local", {normal: [0, 0.6, 0.8]}]])
    test(`samples and pdfs of ${name}.acdf are the program's to the bit`, () => {
        const file = reader.open(readFileSync(`${name}.acdf`)), {u, sampled} = samplesOf(`${name}.csv`);
        assert.equal(sampled.length, 80000);
        assert.deepEqual(file.sample(u, options), sampled);
        assert.deepEqual(file.pdf(directionsOf(sampled), options), densitiesOf(sampled));
        file.close();
        assert.throws(() => file.sample(u, options), AcdfError);
    });

test("what a file is", () => {
    const {info} = reader.open(readFileSync("sky.acdf"));
    assert.equal(info.kind, "environment");
    assert.equal(info.parameterization, "latlong");
    assert.equal(info.bytes, readFileSync("sky.acdf").length);
    assert.deepEqual(info.axes.map(axis => [axis.name, axis.role]), [["phi", "sampled"], ["theta", "sampled"]]);
    assert.equal(info.metadata["source.name"], "sky.pfm");
    assert.ok(info.total > 0 && info.tableBytes > 0);
});

test("a map integrates to 1, and shows the densities of its texels", () => {
    const file = reader.open(readFileSync("sky.acdf")), [width, height] = [512, 256], map = file.map(width, height);
    let sum = 0;
    map.forEach((pdf, i) => {
        sum += pdf * Math.sin(Math.PI * (Math.floor(i / width) + 0.5) / height);
    });
    assert.ok(Math.abs(sum * 2 * Math.PI * Math.PI / (width * height) - 1) < 0.05, `${sum}`);
    const theta = Math.PI * 30.5 / height, phi = Math.PI * (1 - 2 * 100.5 / width);
    const direction = [Math.sin(theta) * Math.cos(phi), Math.sin(theta) * Math.sin(phi), Math.cos(theta)];
    assert.equal(file.pdf(direction)[0], map[30 * width + 100]);
});

test("cells fill the grid, each point once", () => {
    for (const bytes of [readFileSync("sky.acdf"), goldenBytes("halvings_octahedral.acdf")]) {
        const file = reader.open(bytes), cells = file.cells(), {axes} = file.info;
        let area = 0;
        for (let i = 0; i < cells.length; i += 4) area += (cells[i + 1] - cells[i]) * (cells[i + 3] - cells[i + 2]);
        assert.equal(area, axes[0].resolution * axes[1].resolution);
        file.close();
    }
});

test("tables for shaders are those of acdf export", () => {
    const file = reader.open(readFileSync("sky.acdf")), words = file.shaderTables();
    assert.deepEqual(Buffer.from(words.buffer), readFileSync("sky.bin"));
    assert.equal(glsl, readFileSync("sky.glsl", "utf8"));
    assert.equal(wgsl, readFileSync("local.wgsl", "utf8"));
    assert.match(glsl, /AcdfShaderPoint acdf_at\(vec3 normal\)/);
    assert.match(glsl, /AcdfShaderView acdf_view\(vec3 wo\)/);
    assert.deepEqual(Buffer.from(reader.open(readFileSync("local.acdf")).shaderTables().buffer), readFileSync("local.bin"));
    assert.ok(reader.open(goldenBytes("brdf_mirrored.acdf")).shaderTables().length > 32);
    assert.throws(() => reader.open(goldenBytes("tilted.acdf")), /curves/);
    const {width, height, data} = tablesTexture(words);
    assert.equal(width, TABLES_WIDTH);
    assert.equal(data.length, width * height);
    assert.deepEqual(data.subarray(0, words.length), words);
    globalThis.GPUBufferUsage = {STORAGE: 128, COPY_DST: 8};
    const queue = {writeBuffer: (buffer, offset, given) => assert.deepEqual([offset, given], [0, words])};
    assert.equal(createTablesBuffer({queue, createBuffer: made => made}, words).size, words.byteLength);
});

test("every golden file", () => {
    assert.ok(golden.length >= 10);
    for (const name of golden) {
        const file = reader.open(goldenBytes(name));
        const sampled = file.sample([0.5, 0.5, 0, 1, NaN, 2]), density = file.pdf([NaN, 0, 1, 0, 0, 2, 0, 0, 1]);
        assert.equal(sampled.length, 12);
        assert.deepEqual([density[0], density[1]], [0, 0], name);
        file.close();
    }
});

test("damaged files are refused with a line, and harm nothing", () => {
    for (const bytes of [new Uint8Array(), new Uint8Array(1000), new TextEncoder().encode("#?RADIANCE\n")])
        assert.throws(() => reader.open(bytes), error => error instanceof AcdfError && error.rule > 0);
    let refused = 0;
    for (const name of golden) {
        const bytes = goldenBytes(name);
        for (let size = 0; size < bytes.length; size += 1 + (bytes.length >> 6))
            assert.throws(() => reader.open(bytes.subarray(0, size)), AcdfError);
        for (let i = 0; i < 64; ++i) {
            const damaged = Uint8Array.from(bytes);
            damaged[(i * 7919 + 12) % damaged.length] ^= 1 << i % 8;
            try {
                reader.open(damaged).close();
            } catch (error) {
                assert.ok(error instanceof AcdfError, `${error}`);
                ++refused;
            }
        }
    }
    assert.ok(refused > 50 * golden.length);
});

test("memory is given back", () => {
    const bytes = readFileSync("sky.acdf"), u = new Float64Array(20000).fill(0.5);
    for (let i = 0; i < 300; ++i) { // 300 files of some 400 KiB with their tables, and 240 KiB a call
        const file = reader.open(bytes);
        file.sample(u);
        file.shaderTables();
        file.close();
    }
    reader.open(bytes).close();
});

test("calls that cannot be meant", () => {
    const file = reader.open(readFileSync("sky.acdf"));
    assert.throws(() => file.sample([0.5]), RangeError);
    assert.throws(() => file.pdf([0, 0]), RangeError);
    assert.throws(() => file.map(0, 4), RangeError);
    assert.equal(file.sample([]).length, 0);
    assert.equal(file.recommendedLightShare(), 1);
});
