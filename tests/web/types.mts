// Calls of the package as TypeScript sees them; compiled, and never run.
import {AcdfError, AcdfFile, createTablesBuffer, createTablesTexture, loadReader, tablesTexture, TABLES_WIDTH} from "acdf";
import {glsl, wgsl} from "acdf/shaders";
const reader = await loadReader(new URL("acdf.wasm", import.meta.url));
const file: AcdfFile = reader.open(new Uint8Array(4));
const s: Float32Array = file.sample([0, 1], {normal: [0, 0, 1]});
const total: number = file.info.total, role: "indexed" | "sampled" = file.info.axes[0].role;
const words: Uint32Array = file.shaderTables();
declare const gl: WebGL2RenderingContext;
const texture: WebGLTexture = createTablesTexture(gl, words);
const rows = tablesTexture(words).width === TABLES_WIDTH;
createTablesBuffer(null, words);
const text: string = glsl + wgsl;
try { file.close(); } catch (e) { if (e instanceof AcdfError) console.log(e.rule, s, total, role, texture, rows, text); }
// @ts-expect-error: an error where a number is a string, so declarations are looked at
const wrong: string = file.info.total;
