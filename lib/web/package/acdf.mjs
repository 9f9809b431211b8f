// The reader of .acdf files, in WebAssembly. acdf.d.ts documents each call.

const KINDS = {1: "environment", 2: "local", 3: "brdf", 4: "table", 5: "indexed"};
const FITS = {1: "uniform", 2: "cdf", 3: "pdf", 4: "variance"};
const PARAMETERIZATIONS = {1: "latlong", 2: "half-angle", 3: "table", 4: "octahedral"};
const AXIS_BYTES = 48; // of AcdfAxis, format/acdf/layout.h
export const TABLES_WIDTH = 2048; // texels of a row, as the GLSL functions read them

export class AcdfError extends Error {
    constructor(message, rule = 0) {
        super(message);
        this.name = "AcdfError";
        this.rule = rule;
    }
}

async function compiled(source) {
    if (source instanceof WebAssembly.Module) return source;
    if (source instanceof ArrayBuffer || ArrayBuffer.isView(source)) return WebAssembly.compile(source);
    const url = source ?? new URL("acdf.wasm", import.meta.url);
    if (url instanceof URL && url.protocol === "file:") {
        const {readFile} = await import("node:fs/promises");
        return WebAssembly.compile(await readFile(url));
    }
    const response = await fetch(url);
    if (!response.ok) throw new AcdfError(`${url}: cannot be fetched (${response.status})`);
    return WebAssembly.compile(await response.arrayBuffer());
}

export async function loadReader(source) {
    const instance = await WebAssembly.instantiate(await compiled(source)); // which asks nothing of its system
    return new Reader(instance.exports);
}

class Reader {
    #exports;
    constructor(exports) {
        this.#exports = exports;
        exports._initialize?.();
    }
    open(bytes) {
        const view = ArrayBuffer.isView(bytes) ? new Uint8Array(bytes.buffer, bytes.byteOffset, bytes.byteLength)
                                               : new Uint8Array(bytes);
        return new AcdfFile(this.#exports, view);
    }
}

class AcdfFile {
    #exports;
    #opened;
    #info;

    constructor(exports, bytes) {
        this.#exports = exports;
        const place = this.#allocate(bytes.length);
        new Uint8Array(exports.memory.buffer).set(bytes, place);
        this.#opened = exports.acdf_web_open(place, bytes.length);
        if (!this.#opened) throw new AcdfError("out of memory");
        const message = this.#error();
        if (message) {
            const rule = exports.acdf_web_rule(this.#opened);
            this.close();
            throw new AcdfError(message, rule);
        }
        this.#info = this.#read(bytes.length);
    }

    get kind() { return this.#info.kind; }
    get info() { return this.#info; }

    sample(u, options = {}) {
        const count = u.length >> 1, exports = this.#exports;
        if (u.length % 2) throw new RangeError("sample: two random numbers for each direction");
        const numbers = u instanceof Float64Array ? u : Float64Array.from(u);
        return this.#call([[this.#at(options)], [numbers], [Float32Array, 4 * count]], ([at, from, to]) =>
            exports.acdf_web_sample(this.#handle(), at, from, count, to));
    }

    pdf(directions, options = {}) {
        const count = directions.length / 3, exports = this.#exports;
        if (directions.length % 3) throw new RangeError("pdf: three coordinates for each direction");
        const from = directions instanceof Float32Array ? directions : Float32Array.from(directions);
        return this.#call([[this.#at(options)], [from], [Float32Array, count]], ([at, of, to]) =>
            exports.acdf_web_pdf(this.#handle(), at, of, count, to));
    }

    map(width, height, options = {}) {
        if (!(width > 0 && height > 0 && width * height <= 1 << 26)) throw new RangeError("map: 1 to 2^26 texels");
        return this.#call([[this.#at(options)], [Float32Array, width * height]], ([at, to]) =>
            this.#exports.acdf_web_map(this.#handle(), at, width, height, to));
    }

    cells() {
        const count = this.#exports.acdf_web_cells(this.#handle(), 0, 0);
        return this.#call([[Uint32Array, 4 * count]], ([to]) => this.#exports.acdf_web_cells(this.#handle(), to, count));
    }

    recommendedLightShare(options = {}) {
        let share = 1;
        this.#call([[this.#at(options)], [Float32Array, 1]], ([at]) => {
            share = this.#exports.acdf_web_share(this.#handle(), at);
        });
        return share;
    }

    shaderTables() {
        const count = this.#exports.acdf_web_shader_tables(this.#handle());
        if (!count) throw new AcdfError(this.#error());
        const begin = this.#exports.acdf_web_shader_words(this.#handle());
        return new Uint32Array(this.#exports.memory.buffer, begin, count).slice();
    }

    close() {
        if (this.#opened) this.#exports.acdf_web_close(this.#opened);
        this.#opened = 0;
    }

    #handle() {
        if (!this.#opened) throw new AcdfError("the file is closed");
        return this.#opened;
    }

    #allocate(bytes) {
        const place = this.#exports.acdf_web_allocate(bytes);
        if (!place) throw new AcdfError(`no memory for ${bytes} bytes`);
        return place;
    }

    // A normal, or a view; environments need none.
    #at({normal, view}) {
        const at = (this.kind === "brdf" ? view : normal) ?? [0, 0, 1];
        if (at.length !== 3) throw new RangeError("a normal or a view has three coordinates");
        return Float32Array.from(at);
    }

    // Copies arrays in, runs, and copies the last array out; an array to fill is given by its type and length. Memory may
    // move with every allocation, so that views of it are made after the last.
    #call(arrays, run) {
        this.#handle();
        const addresses = [];
        try {
            for (const [array, length] of arrays)
                addresses.push(this.#allocate(length === undefined ? array.byteLength : array.BYTES_PER_ELEMENT * length));
            arrays.forEach(([array, length], i) => {
                if (length === undefined) new array.constructor(this.#exports.memory.buffer, addresses[i]).set(array);
            });
            run(addresses);
            const [Type, length] = arrays.at(-1);
            return new Type(this.#exports.memory.buffer, addresses.at(-1), length).slice();
        } finally {
            addresses.forEach(this.#exports.acdf_web_free);
        }
    }

    #text(begin, size) {
        return new TextDecoder().decode(new Uint8Array(this.#exports.memory.buffer, begin, size).slice());
    }

    #error() {
        const begin = this.#exports.acdf_web_error(this.#opened);
        const bytes = new Uint8Array(this.#exports.memory.buffer, begin);
        return this.#text(begin, bytes.indexOf(0));
    }

    #read(bytes) {
        const exports = this.#exports, opened = this.#opened;
        const description = new DataView(exports.memory.buffer, exports.acdf_web_description(opened));
        const u32 = at => description.getUint32(at, true), f64 = at => description.getFloat64(at, true);
        const info = {
            kind: KINDS[exports.acdf_web_kind(opened)], bytes, tableBytes: exports.acdf_web_table_bytes(opened),
            parameterization: PARAMETERIZATIONS[u32(0)], fit: FITS[u32(4)], filter: u32(8) ? "bilinear" : "nearest",
            bins: u32(24), channelWeights: [f64(32), f64(40), f64(48)], total: f64(56), axes: [], metadata: {}};
        const begin = exports.acdf_web_axes(opened);
        for (let i = 0; i < u32(20); ++i) {
            const axis = new DataView(exports.memory.buffer, begin + AXIS_BYTES * i, AXIS_BYTES);
            info.axes.push({name: this.#text(begin + AXIS_BYTES * i, 16).replace(/\0+$/, ""),
                            role: axis.getUint32(16, true) ? "indexed" : "sampled", resolution: axis.getUint32(24, true),
                            low: axis.getFloat64(32, true), high: axis.getFloat64(40, true)});
        }
        const pair = this.#allocate(16);
        for (let i = 0; i < exports.acdf_web_metadata_count(opened); ++i) {
            exports.acdf_web_metadata(opened, i, pair);
            const [key, keySize, value, valueSize] = new Uint32Array(exports.memory.buffer, pair, 4);
            Object.defineProperty(info.metadata, this.#text(key, keySize),
                                  {value: this.#text(value, valueSize), enumerable: true});
        }
        exports.acdf_web_free(pair);
        return info;
    }
}

// The words of shaderTables() as the rows of an R32UI texture.
export function tablesTexture(words) {
    const height = Math.ceil(words.length / TABLES_WIDTH), data = new Uint32Array(TABLES_WIDTH * height);
    data.set(words);
    return {width: TABLES_WIDTH, height, data};
}

export function createTablesTexture(gl, words) {
    const {width, height, data} = tablesTexture(words), texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.R32UI, width, height, 0, gl.RED_INTEGER, gl.UNSIGNED_INT, data);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    return texture;
}

export function createTablesBuffer(device, words) {
    const buffer = device.createBuffer({size: words.byteLength, usage: GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_DST});
    device.queue.writeBuffer(buffer, 0, words);
    return buffer;
}
