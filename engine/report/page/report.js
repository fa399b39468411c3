// The script of report.html: the comparer, sortable tables, the choice of a device, and tabs of scenes. charts.js draws
// the charts.
// The page works from disk. Pictures are in the page, or beside it if they are many; their linear values are in images/*.js beside it, which the
// comparer loads when it shows a row. Without these files the comparer shows the values of the 8-bit pictures.
"use strict";
(() => {
const loading = new Map(); // file name -> function that takes the file's text

/** Called by images/*.js with the file's own name and its bytes in base64. */
globalThis.catoptric_values = (file, text) => loading.get(file)?.(text);

function load_values(file) {
    return new Promise((resolve, reject) => {
        loading.set(file, text => resolve(Uint8Array.from(atob(text), c => c.charCodeAt(0))));
        const script = document.createElement("script");
        script.src = file;
        script.onload = () => reject(new Error(file + " is broken")); // no effect after a call
        script.onerror = () => reject(new Error(file + " is not beside this page"));
        document.head.append(script);
    });
}

function half_to_float(half) {
    const sign = half & 0x8000 ? -1 : 1, exponent = half >> 10 & 31, fraction = half & 1023;
    if (exponent === 0) return sign * fraction * 2 ** -24;
    if (exponent === 31) return fraction ? NaN : sign * Infinity;
    return sign * (1 + fraction / 1024) * 2 ** (exponent - 15);
}

/** Returns the floats of little-endian halves. */
function halves_to_floats(bytes) {
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    const floats = new Float32Array(bytes.byteLength / 2), table = halves_to_floats.table ??= new Map();
    for (let i = 0; i < floats.length; ++i) {
        const half = view.getUint16(2 * i, true);
        let value = table.get(half);
        if (value === undefined) table.set(half, value = half_to_float(half));
        floats[i] = value;
    }
    return floats;
}

const to_linear = code => code <= 10.31475 ? code / 255 / 12.92 : ((code / 255 + 0.055) / 1.055) ** 2.4;
const kSrgbSteps = 65535;
const srgb_codes = Uint8ClampedArray.from({length: kSrgbSteps + 1}, (_, i) => {
    const x = i / kSrgbSteps;
    return 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
});
/** Returns the displayed byte of a linear value. A value that is not finite shows as 0 or 255. */
const to_srgb_code = x => srgb_codes[Math.min(Math.max(x, 0), 1) * kSrgbSteps + 0.5 | 0];

/** Returns the linear values of an image of the page, before the page's exposure. */
async function read_image(image, exposure) {
    image.loading = "eager"; // a page with many pictures loads those in view alone
    await image.decode();
    const canvas = new OffscreenCanvas(image.naturalWidth, image.naturalHeight);
    const pen = canvas.getContext("2d", {willReadFrequently: true});
    pen.drawImage(image, 0, 0);
    const codes = pen.getImageData(0, 0, canvas.width, canvas.height).data;
    const floats = new Float32Array(canvas.width * canvas.height * 3);
    for (let i = 0; i < floats.length; ++i)
        floats[i] = to_linear(codes[(i / 3 | 0) * 4 + i % 3]) * 2 ** -exposure;
    return floats;
}

/** Makes an element with properties and children. */
function make(tag, properties = {}, ...children) {
    const element = document.createElement(tag);
    for (const [name, value] of Object.entries(properties))
        name in element ? element[name] = value : element.setAttribute(name, value);
    element.append(...children);
    return element;
}

function make_choice(name, options, chosen, on_change) {
    const select = make("select", {}, ...options.map(([value, text]) =>
        make("option", {value, selected: value === chosen}, text)));
    select.addEventListener("change", () => on_change(select.value));
    return [make("label", {}, name + " ", select), select];
}

const format_value = x => Number.isFinite(x) ? String(Number(x.toPrecision(4))) : String(x);

/** Shows two of a comparison's pictures, linked in zoom and exposure, with the values of single pixels. */
class Comparer {
    constructor(place) {
        this.place = place;
        this.data = JSON.parse(place.querySelector("script").textContent);
        const {width, height, exposure, pictures, mirrors_file, lag = []} = this.data;
        // What can be compared: the rows, or the largest lag of a row. Each entry has its own reference, which is its first picture.
        this.instants = [{label: "at rest", mirrors_file, pictures}, ...lag];
        this.instant = this.instants[0];
        Object.assign(this, {width, height, exposure, pictures});
        this.left = "0";
        this.right = String(Math.max(pictures.findIndex(picture => picture.first), 1));
        this.layout = "split", this.show = "picture", this.gain = 1, this.mask = "all";
        this.split = 0.5, this.zoom = 1, this.centre = [width / 2, height / 2];
        this.pixel = [width >> 1, height >> 1];
        this.bitmaps = new Map();
        this.make_controls();
        // A scene on a hidden tab has no size. It loads its pictures when it is first shown.
        new ResizeObserver(() => {
            if (this.shown) this.draw();
            else if (this.canvas.clientWidth > 0 && !this.turn) this.refresh();
        }).observe(this.canvas);
    }

    make_controls() {
        const names = this.list_names();
        const choose = name => value => { this[name] = value, this.refresh(); };
        const [left, left_select] = make_choice("Left", names, this.left, choose("left"));
        const [right, right_select] = make_choice("Right", names, this.right, choose("right"));
        const [instant, instant_select] = make_choice("Instant", this.instants.map(({label}, i) => [String(i), label]), "0",
            value => this.choose_instant(Number(value)));
        const [layout, layout_select] = make_choice("Layout", [["split", "split"], ["flip", "flip"],
            ["beside", "side by side"]], this.layout, choose("layout"));
        const [show, show_select] = make_choice("Show", [["picture", "picture"],
            ["difference", "difference from the reference"], ["error", "FLIP error"],
            ...this.data.causes.length > 0 ? [["causes", "largest cause of the error"]] : []], this.show, choose("show"));
        const [gain] = make_choice("Difference", [1, 2, 4, 8, 16, 32, 64].map(x => [String(x), "×" + x]), "1",
            value => { this.gain = Number(value), this.refresh(); });
        const mirrors = this.data.mirrors.map((name, i) => [String(i + 1), name]);
        const [mask] = make_choice("Pixels", [["all", "all"], ["mirrors", "mirrors"], ...mirrors], "all", choose("mask"));
        this.selects = {left: left_select, right: right_select, instant: instant_select, layout: layout_select, show: show_select};
        const stops = make("output", {}, format_value(this.exposure));
        this.slider = make("input", {type: "range", min: this.exposure - 8, max: this.exposure + 8, step: 0.25,
            value: this.exposure});
        this.slider.addEventListener("input", () => {
            this.exposure = Number(this.slider.value), stops.value = format_value(this.exposure);
            this.refresh();
        });
        const button = (text, label, act) => {
            const element = make("button", {type: "button", "aria-label": label}, text);
            element.addEventListener("click", act);
            return element;
        };
        this.canvas = make("canvas", {tabIndex: 0, role: "img", "aria-label": "Comparer of two pictures. Arrow keys move " +
            "the pixel, with Shift the split; plus and minus zoom; 0 shows all; F, S and B choose the layout; P, D, E " +
            "and C what is shown; brackets change the exposure" + (this.instants.length > 1 ? "; I the instant." : ".")});
        this.values = make("p", {className: "values", "aria-live": "polite"});
        this.note = make("p", {className: "note"});
        this.place.replaceChildren(
            make("div", {className: "controls"}, ...this.instants.length > 1 ? [instant] : [], left, right, layout, show, gain, mask,
                make("label", {}, "Exposure, stops ", this.slider, stops),
                make("span", {}, button("−", "zoom out", () => this.zoom_by(1 / 2)),
                    button("+", "zoom in", () => this.zoom_by(2)), button("all", "show the whole picture", () => this.zoom_by(0)))),
            this.canvas, this.values, this.note);
        this.canvas.addEventListener("keydown", event => this.on_key(event));
        this.canvas.addEventListener("wheel", event => {
            if (document.activeElement !== this.canvas && !event.ctrlKey) return;
            event.preventDefault();
            this.zoom_by(event.deltaY < 0 ? 2 : 1 / 2, this.find_pixel(event));
        }, {passive: false});
        this.canvas.addEventListener("pointerdown", event => this.on_pointer_down(event));
        this.canvas.addEventListener("pointermove", event => this.on_pointer_move(event));
    }

    list_names() {
        return this.pictures.map((picture, i) => [String(i), picture.label]);
    }

    /** Chooses what is compared, by its index, without drawing. Pictures of a lag have no maps. */
    set_instant(index) {
        if (this.instant === this.instants[index]) return;
        for (const picture of this.pictures) delete picture.values; // they load again
        delete this.mirrors;
        this.bitmaps.clear();
        this.telling = (this.telling ?? 0) + 1; // the line of values tells nothing of the earlier instant
        this.instant = this.instants[index], this.pictures = this.instant.pictures;
        this.selects.instant.value = String(index);
        for (const side of ["left", "right"])
            this.selects[side].replaceChildren(...this.list_names().map(([value, text]) => make("option", {value}, text)));
        for (const option of this.selects.show.options)
            option.disabled = index > 0 && ["error", "causes"].includes(option.value);
        if (this.selects.show.selectedOptions[0].disabled) this.selects.show.value = this.show = "picture";
    }

    /** Shows the reference of an instant beside its first row, or beside the row that the page shows first. */
    choose_instant(index) {
        this.set_instant(index);
        this.show_beside_reference(Math.max(this.pictures.findIndex(picture => picture.first), 1));
    }

    /** Shows a row, by the index of its picture, beside the reference. */
    choose_picture(index) {
        this.set_instant(0);
        this.show_beside_reference(index);
    }

    show_beside_reference(index) {
        this.selects.left.value = this.left = "0";
        this.selects.right.value = this.right = String(index);
        this.refresh();
    }

    /** Loads the linear values of a picture once. */
    load(index) {
        const picture = this.pictures[index];
        const image = () => document.getElementById(picture.picture_id);
        return picture.values ??= load_values(picture.file).then(halves_to_floats).catch(async error => {
            this.note.textContent = `Values are those of the 8-bit pictures, because ${error.message}.`;
            return read_image(image(), this.data.exposure).catch(() => { // a picture that lies beside the page
                this.note.textContent = `The picture cannot be shown, because ${error.message}.`;
                return new Float32Array(this.width * this.height * 3);
            });
        });
    }

    /**
     * Loads a map of a row once, its heat map of FLIP ("error") or its largest causes ("causes"): from the file beside
     * the page, or from the page. Returns null if the row has no such map.
     */
    async load_map(index, kind) {
        if (!this.pictures[index]) return null; // of another instant
        const {file, id} = this.pictures[index][kind], image = id && document.getElementById(id);
        if (!image) return null;
        return (this.maps ??= new Map()).get(file) ?? this.maps.set(file, load_values(file)
            .then(bytes => createImageBitmap(new Blob([bytes], {type: "image/png"})))
            .catch(async () => {
                await image.decode();
                return image;
            })).get(file);
    }

    load_mirrors() {
        return this.mirrors ??= load_values(this.instant.mirrors_file)
            .then(bytes => new Uint16Array(bytes.buffer, bytes.byteOffset, bytes.byteLength / 2)).catch(() => null);
    }

    /** Returns a canvas with one picture as the controls ask for it. */
    async make_bitmap(index) {
        const {show, exposure, gain, mask, instant} = this; // the controls may change while files are loaded
        const key = [index, show, exposure, gain, mask].join();
        const known = this.bitmaps.get(key);
        if (known) return known;
        const [floats, reference, mirrors] = await Promise.all([this.load(index), this.load("0"), this.load_mirrors()]);
        const canvas = new OffscreenCanvas(this.width, this.height), pen = canvas.getContext("2d", {willReadFrequently: true});
        const map = ["error", "causes"].includes(show) ? await this.load_map(index, show) : null;
        if (map) pen.drawImage(map, 0, 0, this.width, this.height);
        const image = pen.getImageData(0, 0, this.width, this.height), scale = 2 ** exposure;
        const shows_mirror = mirror => mask === "mirrors" ? mirror > 0 : mirror === Number(mask);
        for (let i = 0; i < this.width * this.height; ++i) {
            const dim = mask !== "all" && mirrors && !shows_mirror(mirrors[i]) ? 0.2 : 1;
            for (let k = 0; k < 3; ++k) {
                const x = floats[3 * i + k];
                if (show === "picture") image.data[4 * i + k] = to_srgb_code(x * scale);
                if (show === "difference")
                    image.data[4 * i + k] = to_srgb_code(Math.abs(x - reference[3 * i + k]) * scale * gain);
                image.data[4 * i + k] *= dim;
            }
            image.data[4 * i + 3] = 255;
        }
        pen.putImageData(image, 0, 0);
        if (this.bitmaps.size > 8) this.bitmaps.clear();
        if (instant === this.instant) this.bitmaps.set(key, canvas);
        return canvas;
    }

    /** Draws again after a change of what is shown. */
    async refresh() {
        const turn = this.turn = (this.turn ?? 0) + 1;
        const indices = [this.left, this.right];
        const bitmaps = await Promise.all(indices.map(index => this.make_bitmap(index)));
        if (turn !== this.turn) return; // a later change draws
        this.shown = bitmaps.map((bitmap, side) => ({bitmap, label: this.pictures[indices[side]].label}));
        this.forget_unused(indices);
        this.draw();
        await this.tell_values();
        this.place.dataset.ready = String(turn);
    }

    /** Returns each drawn pane: its place on the canvas and its picture, 0 (left) or 1 (right). */
    list_panes() {
        const {width, height} = this.canvas;
        if (this.layout === "flip") return [{x: 0, end: width, of: this.flipped ? 1 : 0, from: 0, width, height}];
        if (this.layout === "beside")
            return [0, 1].map(of => ({x: of * width / 2, end: (of + 1) * width / 2 - 1, of, from: of * width / 2,
                width: width / 2, height}));
        const middle = this.split * width;
        return [{x: 0, end: middle, of: 0, from: 0, width, height}, {x: middle, end: width, of: 1, from: 0, width, height}];
    }

    /** Returns canvas pixels per picture pixel, and the canvas position of the picture's corner in a pane. */
    find_view(pane) {
        const scale = Math.min(pane.width / this.width, pane.height / this.height) * this.zoom;
        return {scale, x: pane.from + pane.width / 2 - this.centre[0] * scale, y: pane.height / 2 - this.centre[1] * scale};
    }

    draw() {
        if (!this.shown) return;
        const ratio = globalThis.devicePixelRatio || 1, panes = this.layout === "beside" ? 2 : 1;
        const wide = Math.round(this.canvas.clientWidth * ratio);
        const high = Math.round(Math.min(wide / panes * this.height / this.width, 0.72 * globalThis.innerHeight * ratio));
        if (this.canvas.width !== wide || this.canvas.height !== high)
            this.canvas.width = wide, this.canvas.height = high;
        const pen = this.canvas.getContext("2d");
        pen.fillStyle = "#222", pen.fillRect(0, 0, wide, high);
        for (const pane of this.list_panes()) {
            const {scale, x, y} = this.find_view(pane);
            pen.save();
            pen.beginPath(), pen.rect(pane.x, 0, pane.end - pane.x, high), pen.clip();
            pen.imageSmoothingEnabled = scale < 1;
            pen.drawImage(this.shown[pane.of].bitmap, x, y, this.width * scale, this.height * scale);
            pen.strokeStyle = "#fff", pen.lineWidth = ratio;
            pen.strokeRect(x + this.pixel[0] * scale, y + this.pixel[1] * scale, Math.max(scale, 3), Math.max(scale, 3));
            this.draw_name(pen, pane, ratio);
            pen.restore();
        }
        if (this.layout === "split") pen.fillStyle = "#fff", pen.fillRect(this.split * wide - ratio, 0, 2 * ratio, high);
    }

    draw_name(pen, pane, ratio) {
        const name = this.shown[pane.of].label;
        pen.font = `${13 * ratio}px system-ui, sans-serif`;
        const size = pen.measureText(name).width + 12 * ratio, right = this.layout === "split" && pane.of === 1;
        const x = right ? pane.end - size - 6 * ratio : pane.x + 6 * ratio;
        pen.fillStyle = "rgb(0 0 0 / 65%)", pen.fillRect(x, 6 * ratio, size, 22 * ratio);
        pen.fillStyle = "#fff", pen.fillText(name, x + 6 * ratio, 21 * ratio);
    }

    /** Frees the values of all pictures but the reference and those shown, which load again. */
    forget_unused(indices) {
        this.pictures.forEach((picture, i) => { if (i > 0 && !indices.includes(String(i))) delete picture.values; });
    }

    /** Returns the name of the largest cause of a row's error in a pixel; "" if causes are not shown or there is none. */
    async find_cause(index, x, y) {
        const map = this.show === "causes" ? await this.load_map(index, "causes") : null;
        if (!map) return "";
        const pen = new OffscreenCanvas(1, 1).getContext("2d");
        pen.drawImage(map, -x, -y);
        const found = Array.from(pen.getImageData(0, 0, 1, 1).data.slice(0, 3)).join();
        return this.data.causes.find(cause => cause.colour.join() === found)?.name ?? "";
    }

    /** Says the linear values of the chosen pixel, and the largest cause of its error if causes are shown. */
    async tell_values() {
        const turn = this.telling = (this.telling ?? 0) + 1;
        const [x, y] = this.pixel, at = 3 * (y * this.width + x);
        const mirrors = await this.load_mirrors(), mirror = mirrors ? mirrors[y * this.width + x] : 0;
        const parts = [];
        for (const index of new Set(["0", this.left, this.right])) {
            if (turn !== this.telling) return; // a later call tells
            const label = this.pictures[index].label; // the instant may change while pictures load
            const floats = await this.load(index);
            const cause = await this.find_cause(index, x, y);
            parts.push(`${label}: ${Array.from(floats.slice(at, at + 3), format_value).join(" ")}` +
                (cause && ` (${cause})`));
        }
        if (turn !== this.telling) return; // a later call tells
        const where = mirror > 0 ? `, ${this.data.mirrors[mirror - 1]}` : "";
        this.values.textContent = `Pixel ${x}, ${y}${where}. Linear values, as half floats: ${parts.join("; ")}.`;
    }

    /** Returns the pixel of the picture under the pointer, as fractions. */
    find_pixel(event) {
        const ratio = this.canvas.width / this.canvas.clientWidth;
        const at = event.offsetX * ratio, panes = this.list_panes();
        const {scale, x, y} = this.find_view(panes.find(pane => at >= pane.x && at <= pane.end) ?? panes[0]);
        return [(at - x) / scale, (event.offsetY * ratio - y) / scale];
    }

    move_pixel(x, y) {
        this.pixel = [Math.min(Math.max(Math.floor(x), 0), this.width - 1), Math.min(Math.max(Math.floor(y), 0), this.height - 1)];
        this.draw(), this.tell_values();
    }

    /** Zooms by a factor around a position, the chosen pixel by default; 0 shows the whole picture. */
    zoom_by(factor, about = [this.pixel[0] + 0.5, this.pixel[1] + 0.5]) {
        const before = this.zoom;
        this.zoom = factor === 0 ? 1 : Math.min(Math.max(this.zoom * factor, 1), 256);
        const keep = before / this.zoom;
        for (const k of [0, 1]) this.centre[k] = about[k] + (this.centre[k] - about[k]) * keep;
        if (this.zoom === 1) this.centre = [this.width / 2, this.height / 2];
        this.draw();
    }

    set_layout(layout) {
        if (layout === "flip" && this.layout === "flip") this.flipped = !this.flipped;
        this.selects.layout.value = this.layout = layout;
        this.draw();
    }

    set_show(show) {
        if (Array.from(this.selects.show.options).some(option => option.value === show && option.disabled)) return;
        this.selects.show.value = this.show = show;
        this.refresh();
    }

    on_key(event) {
        if (event.ctrlKey || event.altKey || event.metaKey) return;
        const [x, y] = this.pixel, step = 0.02;
        const move_split = by => { this.split = Math.min(Math.max(this.split + by, 0), 1), this.draw(); };
        const move_exposure = by => { this.slider.value = this.exposure + by, this.slider.dispatchEvent(new Event("input")); };
        const keys = {
            ArrowLeft: () => event.shiftKey ? move_split(-step) : this.move_pixel(x - 1, y),
            ArrowRight: () => event.shiftKey ? move_split(step) : this.move_pixel(x + 1, y),
            ArrowUp: () => this.move_pixel(x, y - 1),
            ArrowDown: () => this.move_pixel(x, y + 1),
            "+": () => this.zoom_by(2), "=": () => this.zoom_by(2), "-": () => this.zoom_by(1 / 2), "0": () => this.zoom_by(0),
            f: () => this.set_layout("flip"), s: () => this.set_layout("split"), b: () => this.set_layout("beside"),
            p: () => this.set_show("picture"), d: () => this.set_show("difference"), e: () => this.set_show("error"),
            ...this.data.causes.length > 0 && {c: () => this.set_show("causes")},
            ...this.instants.length > 1 && {
                i: () => this.choose_instant((this.instants.indexOf(this.instant) + 1) % this.instants.length),
            },
            "[": () => move_exposure(-0.5), "]": () => move_exposure(0.5),
        };
        const act = keys[event.key] ?? keys[event.key.toLowerCase()];
        if (!act) return;
        event.preventDefault();
        act();
    }

    on_pointer_down(event) {
        const ratio = this.canvas.width / this.canvas.clientWidth;
        this.drags_split = this.layout === "split" && Math.abs(event.offsetX * ratio - this.split * this.canvas.width) < 12 * ratio;
        this.canvas.setPointerCapture(event.pointerId);
        if (!this.drags_split) this.move_pixel(...this.find_pixel(event));
    }

    on_pointer_move(event) {
        if (!(event.buttons & 1)) return;
        if (this.drags_split) {
            this.split = Math.min(Math.max(event.offsetX / this.canvas.clientWidth, 0), 1);
        } else if (this.zoom > 1) {
            const {scale} = this.find_view(this.list_panes()[0]), ratio = this.canvas.width / this.canvas.clientWidth;
            this.centre[0] -= event.movementX * ratio / scale, this.centre[1] -= event.movementY * ratio / scale;
        }
        this.draw();
    }
}

/** Sorts the rows of a table by a column when the column's header is pressed: up, down. */
function make_sortable(table) {
    const headers = Array.from(table.tHead.rows[0].cells), body = table.tBodies[0];
    const read = (row, column) => {
        const text = row.cells[column].textContent.trim(), number = parseFloat(text.replace(/^[^\d.+-]+/, ""));
        return {text, number: Number.isNaN(number) ? Infinity : number};
    };
    headers.forEach((header, column) => {
        const button = make("button", {type: "button", className: "sort"}, ...header.childNodes);
        header.replaceChildren(button);
        button.addEventListener("click", () => {
            const down = header.ariaSort === "ascending";
            headers.forEach(other => other.removeAttribute("aria-sort"));
            header.setAttribute("aria-sort", down ? "descending" : "ascending");
            const is_text = header.classList.contains("text");
            const order = (a, b) => {
                const x = read(a, column), y = read(b, column);
                return is_text || x.number === y.number ? x.text.localeCompare(y.text) : x.number - y.number;
            };
            body.append(...Array.from(body.rows).sort((a, b) => down ? order(b, a) : order(a, b)));
        });
    });
}

/** Shows one scene's section at a time. */
function make_tabs(links) {
    const sections = links.map(link => document.getElementById(link.hash.slice(1)));
    const show = () => {
        const chosen = Math.max(links.findIndex(link => {
            const target = document.getElementById(location.hash.slice(1));
            return link.hash === location.hash || (target && document.getElementById(link.hash.slice(1)).contains(target));
        }), 0);
        sections.forEach((section, i) => { section.hidden = i !== chosen; });
        links.forEach((link, i) => i === chosen ? link.setAttribute("aria-current", "true") : link.removeAttribute("aria-current"));
    };
    addEventListener("hashchange", show);
    show();
}

for (const place of document.querySelectorAll(".comparer")) {
    const comparer = new Comparer(place);
    const section = place.closest(".scene") ?? document;
    section.addEventListener("choose-picture", event => { // of a chart
        comparer.choose_picture(event.detail);
        place.scrollIntoView({block: "nearest"});
    });
}
for (const choice of document.querySelectorAll(".devices")) { // of this comparison alone
    const section = choice.closest(".scene") ?? document;
    const show = () => {
        for (const block of section.querySelectorAll("[data-device]"))
            block.hidden = block.dataset.device !== choice.value;
    };
    choice.addEventListener("change", show);
    show(); // a reloaded page keeps its choice
}
addEventListener("beforeprint", () => document.querySelectorAll("img").forEach(image => { image.loading = "eager"; }));
document.querySelectorAll(".scroll table").forEach(make_sortable);
const links = Array.from(document.querySelectorAll("nav a"));
if (links.length > 1) make_tabs(links);
})();
