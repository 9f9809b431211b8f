// The page: shows the file that was dropped on it. `loadReader` and WASM (base64) stand before this text in the built page.

const $ = id => document.getElementById(id);
const MAP_WIDTH = 1024, MAP_HEIGHT = 512;
const state = {file: null, name: "", pdfs: null, range: [0, 1], seed: 1};

// A false-colour scale that grows lighter evenly: five colours of viridis and what lies between them.
const COLOURS = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];
function colour(t) {
    const x = Math.min(Math.max(t, 0), 1) * (COLOURS.length - 1), i = Math.min(Math.floor(x), COLOURS.length - 2);
    return COLOURS[i].map((from, k) => Math.round(from + (COLOURS[i + 1][k] - from) * (x - i)));
}

const digits = (x, n = 4) => Number(x).toPrecision(n).replace(/\.?0+(e|$)/, "$1");
const bytesText = n => n < 10240 ? `${n} bytes` : n < 10485760 ? `${digits(n / 1024, 3)} KiB` : `${digits(n / 1048576, 3)} MiB`;

function options() {
    const theta = $("theta").value * Math.PI / 180, phi = $("phi").value * Math.PI / 180;
    const at = [Math.sin(theta) * Math.cos(phi), Math.sin(theta) * Math.sin(phi), Math.cos(theta)];
    return {normal: at, view: at};
}

// ---- the map --------------------------------------------------------------------------------------------------

function showPdf() {
    const pdfs = state.pdfs = state.file.map(MAP_WIDTH, MAP_HEIGHT, options());
    const positive = pdfs.filter(pdf => pdf > 0).sort();
    const highest = positive.at(-1) ?? 1, high = positive[Math.floor(positive.length * 0.998)] ?? 1;
    const most = highest > 10 * high ? high : highest; // a sun would leave nothing to be seen of the rest
    const least = Math.max(positive[0] ?? 1, most * 1e-5);
    const low = Math.log(least), width = Math.max(Math.log(most) - low, 1e-9);
    const canvas = $("map"), context = canvas.getContext("2d");
    canvas.width = MAP_WIDTH;
    canvas.height = MAP_HEIGHT;
    const image = context.createImageData(MAP_WIDTH, MAP_HEIGHT);
    pdfs.forEach((pdf, i) => {
        image.data.set(pdf > 0 ? colour((Math.log(pdf) - low) / width) : [0, 0, 0], 4 * i);
        image.data[4 * i + 3] = 255;
    });
    context.putImageData(image, 0, 0);
    $("least").textContent = (positive[0] < least ? "≤ " : "") + digits(least, 3);
    $("most").textContent = (highest > most ? "≥ " : "") + digits(most, 3);
    const scale = $("scale").getContext("2d");
    for (let i = 0; i < 256; ++i) {
        scale.fillStyle = `rgb(${colour(i / 255)})`;
        scale.fillRect(i, 0, 1, 1);
    }
}

// The position of a direction in the map, from 0 to 1.
function position(x, y, z) {
    return [0.5 - Math.atan2(y, x) / (2 * Math.PI), Math.atan2(Math.hypot(x, y), z) / Math.PI];
}

function direction(left, top) {
    const phi = Math.PI * (1 - 2 * left), theta = Math.PI * top;
    return [Math.sin(theta) * Math.cos(phi), Math.sin(theta) * Math.sin(phi), Math.cos(theta)];
}

// The direction that the equal-area octahedral square shows at (u, v): SPEC.md 6.6.
function octahedral(u, v) {
    const a = Math.abs(2 * u - 1), b = Math.abs(2 * v - 1), beyond = a + b - 1, r = 1 - Math.abs(beyond);
    const phi = Math.PI / 4 * (r > 0 ? 1 + (b - a) / r : 1), sine = r * Math.sqrt(2 - r * r);
    const x = sine * Math.cos(phi), y = sine * Math.sin(phi);
    return [u > 0.5 ? -x : x, v < 0.5 ? -y : y, beyond > 0 ? r * r - 1 : 1 - r * r];
}

// ---- cells and samples over it --------------------------------------------------------------------------------

function outline(context, cell, [columns, rows], square, width, height) {
    const [left, right, top, bottom] = cell;
    if (!square) {
        context.rect(left / columns * width, top / rows * height, (right - left) / columns * width,
                     (bottom - top) / rows * height);
        return;
    }
    const corners = [[left, top], [right, top], [right, bottom], [left, bottom], [left, top]], steps = 6;
    let before = null;
    for (let i = 0; i < 4 * steps + 1; ++i) {
        const from = corners[Math.floor(i / steps)], to = corners[Math.min(Math.floor(i / steps) + 1, 4)];
        const t = i % steps / steps;
        const at = position(...octahedral((from[0] + (to[0] - from[0]) * t) / columns, (from[1] + (to[1] - from[1]) * t) / rows));
        if (before === null || Math.abs(before[0] - at[0]) > 0.5) context.moveTo(at[0] * width, at[1] * height);
        else context.lineTo(at[0] * width, at[1] * height);
        before = at;
    }
}

function paintCells(context, width, height) {
    const cells = state.file.cells(), {axes, parameterization} = state.file.info;
    context.strokeStyle = "#fff7";
    context.lineWidth = Math.max(0.5, devicePixelRatio * 0.5);
    context.beginPath();
    for (let i = 0; i < cells.length; i += 4)
        outline(context, cells.subarray(i, i + 4), axes.map(axis => axis.resolution), parameterization === "octahedral",
                width, height);
    context.stroke();
}

// Random numbers that come again: the same file and seed give the same samples. One in each of count boxes.
function numbers(count) {
    let word = state.seed >>> 0;
    const random = () => {
        word = Math.imul(word, 747796405) + 2891336453 >>> 0;
        const mixed = Math.imul((word >>> (word >>> 28) + 4) ^ word, 277803737) >>> 0;
        return ((mixed >>> 22 ^ mixed) >>> 0) / 4294967296;
    };
    const side = Math.round(Math.sqrt(count)), u = new Float64Array(2 * count);
    for (let i = 0; i < count; ++i) {
        u[2 * i] = (i % side + random()) / side;
        u[2 * i + 1] = (Math.floor(i / side) + random()) / side;
    }
    return u;
}

function paintSamples(context, width, height) {
    const count = Number($("count").value), samples = state.file.sample(numbers(count), options());
    const radius = Math.max(1, (count > 2000 ? 0.8 : 1.4) * devicePixelRatio);
    context.fillStyle = "#fff";
    context.strokeStyle = "#000";
    context.lineWidth = devicePixelRatio * 0.5;
    for (let i = 0; i < count; ++i) {
        if (!(samples[4 * i + 3] > 0)) continue;
        const [left, top] = position(samples[4 * i], samples[4 * i + 1], samples[4 * i + 2]);
        context.beginPath();
        context.arc(left * width, top * height, radius, 0, 2 * Math.PI);
        context.fill();
        context.stroke();
    }
}

function showOverlay() {
    const overlay = $("overlay"), box = overlay.getBoundingClientRect();
    overlay.width = Math.round(box.width * devicePixelRatio);
    overlay.height = Math.round(box.height * devicePixelRatio);
    const context = overlay.getContext("2d");
    if ($("cells").checked) paintCells(context, overlay.width, overlay.height);
    paintSamples(context, overlay.width, overlay.height);
}

// ---- figures --------------------------------------------------------------------------------------------------

function timeOfASample() {
    const count = 20000, u = numbers(count), begin = performance.now();
    state.file.sample(u, options());
    return (performance.now() - begin) * 1e6 / count;
}

function figures() {
    const {info} = state.file, {metadata} = info, rows = [["Kind", `${info.kind}, ${info.parameterization}`]];
    const add = (name, value) => value !== undefined && rows.push([name, value]);
    add("Size", bytesText(info.bytes));
    add("Tables in memory", info.tableBytes ? bytesText(info.tableBytes) : "none");
    if (info.kind === "environment") add("Cells", String(state.file.cells().length / 4));
    if (info.bins > 1) add("Bins", String(info.bins));
    add("Axes", info.axes.map(axis => `${axis.name} ${axis.resolution}${axis.role === "indexed" ? " (indexed)" : ""}`).join(", "));
    add("Fit", info.fit + (metadata["fit.options"] ? ` ${metadata["fit.options"]}` : ""));
    add("Total", digits(info.total, 6));
    add("Source", metadata["source.name"]);
    for (const [key, value] of Object.entries(metadata))
        if (key.startsWith("accuracy."))
            add(key.slice(9).replaceAll("_", " ").replace(/^./, c => c.toUpperCase()), isFinite(value) ? digits(value) : value);
    if (info.kind !== "table") add("Time of a sample here", `${Math.round(timeOfASample())} ns`);
    $("figures").replaceChildren(...rows.map(([name, value]) => {
        const row = document.createElement("tr"), head = document.createElement("th"), cell = document.createElement("td");
        head.scope = "row";
        head.textContent = name;
        cell.textContent = value;
        row.append(head, cell);
        return row;
    }));
}

// ---- the page -------------------------------------------------------------------------------------------------

function fail(text) {
    $("message").textContent = text;
    $("message").hidden = false;
    $("view").hidden = true;
}

function showAt() {
    for (const id of ["theta", "phi"]) $(`${id}-value`).textContent = `${$(id).value}°`;
}

function refresh() {
    showAt();
    if (!state.file || state.file.kind === "table") return;
    showPdf();
    showOverlay();
}

async function show(dropped) {
    const reader = await ready;
    let opened;
    try {
        opened = reader.open(await dropped.arrayBuffer());
    } catch (error) {
        return fail(`${dropped.name}: ${error.message}`);
    }
    state.file?.close();
    state.file = opened;
    $("message").hidden = true;
    $("view").hidden = false;
    $("name").textContent = dropped.name;
    const {kind} = opened;
    $("at").hidden = kind !== "local" && kind !== "brdf";
    $("at").firstElementChild.textContent = kind === "brdf" ? "View" : "Normal";
    $("theta").max = kind === "brdf" ? 89 : 180;
    $("theta").value = kind === "brdf" ? 45 : 0;
    $("phi").value = 0;
    $("controls").querySelector(".cells").hidden = kind !== "environment";
    document.querySelector("#view section").hidden = kind === "table";
    $("readout").textContent = "Point at the map to see the pdf there.";
    refresh();
    figures();
    document.body.dataset.shown = dropped.name;
}

function showReadout(event) {
    const box = $("stage").getBoundingClientRect();
    const left = (event.clientX - box.left) / box.width, top = (event.clientY - box.top) / box.height;
    if (!state.file || left < 0 || left >= 1 || top < 0 || top >= 1) return;
    const d = direction(left, top), [pdf] = state.file.pdf(d, options());
    $("readout").textContent = `φ ${(180 - 360 * left).toFixed(1)}°, θ ${(180 * top).toFixed(1)}°: (${
        d.map(x => x.toFixed(3)).join(", ")}), pdf ${digits(pdf, 6)} sr⁻¹`;
}

const ready = loadReader(Uint8Array.from(atob(WASM), c => c.charCodeAt(0)));
ready.catch(error => fail(`This browser does not run the reader: ${error.message}`));
// The file that `acdf view` put into the page (base64).
const opened = $("opened");
if (opened)
    show(new File([Uint8Array.from(atob(opened.textContent.trim()), c => c.charCodeAt(0))], opened.dataset.name));
$("file").addEventListener("change", event => event.target.files[0] && show(event.target.files[0]));
for (const name of ["dragover", "dragleave", "drop"])
    addEventListener(name, event => {
        event.preventDefault();
        $("drop").classList.toggle("over", name === "dragover");
        if (name === "drop" && event.dataTransfer.files[0]) show(event.dataTransfer.files[0]);
    });
for (const id of ["cells", "count"]) $(id).addEventListener("change", showOverlay);
for (const id of ["theta", "phi"]) $(id).addEventListener("input", refresh);
$("again").addEventListener("click", () => {
    ++state.seed;
    showOverlay();
});
for (const name of ["pointermove", "pointerdown"]) $("stage").addEventListener(name, showReadout);
addEventListener("resize", () => state.file && state.file.kind !== "table" && showOverlay());
$("controls").addEventListener("submit", event => event.preventDefault());
showAt();
