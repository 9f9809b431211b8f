/** Why a file was refused, or a call failed. */
export class AcdfError extends Error {
    /** Number of the broken rule of SPEC.md; 0: none. */
    readonly rule: number;
}

export interface Axis {
    name: string;
    role: "indexed" | "sampled";
    /** Positions run from 0 to this. */
    resolution: number;
    /** Coordinate at position 0 and at `resolution`. */
    low: number;
    high: number;
}

export interface Info {
    kind: "environment" | "local" | "brdf" | "table" | "indexed";
    /** Of the file. */
    bytes: number;
    /** Of the runtime tables; 0: none. */
    tableBytes: number;
    parameterization: "latlong" | "octahedral" | "half-angle" | "table";
    /** Always "variance": files of the other fits are refused. */
    fit: "uniform" | "cdf" | "pdf" | "variance";
    filter: "nearest" | "bilinear";
    bins: number;
    channelWeights: [number, number, number];
    /** Integral of the sampled function over its domain: of environments luminance times sr. */
    total: number;
    axes: Axis[];
    /** What the file carries: source.name, accuracy.relative_variance, ... */
    metadata: Record<string, string>;
}

/** Which of a file's pdfs is meant: of a local environment file by the normal, of a BRDF by the direction towards
 * the viewer in the surface's frame; [0, 0, 1] where it is left out. */
export interface At {
    normal?: ArrayLike<number>;
    view?: ArrayLike<number>;
}

/** An accepted file. Directions are unit vectors towards the light, right-handed, z up; pdfs in sr^-1. */
export interface AcdfFile {
    readonly kind: Info["kind"];
    readonly info: Info;
    /** Samples for pairs of random numbers in [0, 1]: x y z pdf for each, 4 floats. Not of tables (pdf 0). */
    sample(u: ArrayLike<number>, at?: At): Float32Array;
    /** Pdfs of directions, x y z each; 0 where no sample falls, for NaN and for directions of another length. */
    pdf(directions: ArrayLike<number>, at?: At): Float32Array;
    /** Pdfs at the middles of the texels of a lat-long map, row by row from the top: phi = pi at the left. */
    map(width: number, height: number, at?: At): Float32Array;
    /** Of an environment: first and last position on axis 0, then on axis 1, 4 numbers a cell. Empty of other kinds. */
    cells(): Uint32Array;
    /** Of the samples of both, how many to sample from this file where it has an MIS partner, in (0, 1]. */
    recommendedLightShare(at?: At): number;
    /** Words for the functions of "acdf/shaders", of an environment, a local environment or a BRDF. Throws AcdfError. */
    shaderTables(): Uint32Array;
    /** Gives the memory back. What is called then throws. */
    close(): void;
}

export interface Reader {
    /** Checks any bytes. Throws AcdfError with a line that says what is wrong. */
    open(bytes: ArrayBuffer | ArrayBufferView): AcdfFile;
}

/** The reader. `source`: acdf.wasm as a URL, bytes or a compiled module; by default the file beside this module. */
export function loadReader(source?: string | URL | ArrayBuffer | ArrayBufferView | WebAssembly.Module): Promise<Reader>;

/** Texels of a row of the texture that the GLSL functions read. */
export const TABLES_WIDTH: number;
/** The words of shaderTables() as rows of an R32UI texture, padded: for engines that upload themselves. */
export function tablesTexture(words: Uint32Array): { width: number; height: number; data: Uint32Array };
/** The same as a texture of WebGL 2, bound to TEXTURE_2D of the active unit; its uniform is `acdf_tables`. */
export function createTablesTexture(gl: WebGL2RenderingContext, words: Uint32Array): WebGLTexture;
/** The words as a storage buffer of WebGPU. */
export function createTablesBuffer(device: any, words: Uint32Array): any;
