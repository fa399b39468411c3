// The map of the trade: which row is best on which device, computed in the page from counted work (study/map.cpp). The
// time of a row is the sum over kinds of work of count times cost. Work of a frame in which captures are drawn beyond
// that of a frame at rest is shared by the frames between two drawings.
"use strict";
(() => {
const kSteps = {raster: 48, period: 48, pixels: 48}; // cells of a map along each axis
const kRasterPowers = [-6, 6], kPeriodPowers = [0, 6], kEdgePowers = [6, 12]; // of 2
const kPalette = ["#4269d0", "#efb118", "#3ca951", "#ff725c", "#a463f2", "#97bbf5", "#9c6b4e", "#6cc5b0", "#ff8ab7", "#9498a0"];
const kNone = "#777";

const format_ms = x => !Number.isFinite(x) ? "–" : x >= 100 ? x.toFixed(0) : String(Number(x.toPrecision(3)));
const format_factor = x => x === Infinity ? "over 1000×" : String(Number(x.toPrecision(2))) + "×";

function make(tag, properties = {}, ...children) {
    const element = document.createElement(tag);
    for (const [name, value] of Object.entries(properties))
        name in element ? element[name] = value : element.setAttribute(name, value);
    element.append(...children);
    return element;
}

/**
 * Returns the time of a row at a point, ms. `bound`: undefined takes the given costs, "rays" the lowest costs of rays and
 * the highest of all other work, "raster" the other way round.
 */
function predict(data, device, row, point, bound) {
    let ms = 0;
    for (const {kind, ns, low, high} of device.units) {
        const {is_ray, is_raster, grows} = data.kinds[kind];
        const rest = row.rest[kind] * (grows ? point.pixels : 1);
        const captures = Math.max(row.drawn[kind] - row.rest[kind], 0) / point.period;
        const cost = bound === undefined ? ns : is_ray === (bound === "rays") ? low : high;
        ms += (rest + captures) * cost * (is_raster ? point.raster : 1) * 1e-6;
    }
    return ms;
}

/** Returns whether row a beats row b in time and FLIP. */
const beats = (a, b) => a.ms <= b.ms && a.flip <= b.flip && (a.ms < b.ms || a.flip < b.flip);

/** Returns the judged rows with their times, and whether each is on the front, as measure::map_front does. */
function find_rows(data, device, point, bound) {
    const rows = data.rows.map((row, index) => ({index, flip: row.flip, ms: predict(data, device, row, point, bound)}));
    for (const row of rows) row.front = !rows.some(other => beats(other, row));
    return rows;
}

/** Returns the index of the fastest row with at most this FLIP, or -1. */
function find_best(data, device, point, bound) {
    let best = -1, least = Infinity;
    data.rows.forEach((row, index) => {
        if (!(row.flip <= point.max_flip)) return;
        const ms = predict(data, device, row, point, bound);
        if (ms < least) best = index, least = ms;
    });
    return best;
}

/** Returns the factor by which raster work may become dearer before a row of the front leaves it. */
function find_margin(data, device, point, index) {
    const on_front = power => find_rows(data, device, {...point, raster: point.raster * 2 ** power})[index].front;
    if (!on_front(0)) return NaN;
    let low = 0, high = 10;
    for (; low < high && on_front(Math.min(low + 0.25, high)); low += 0.25);
    if (low >= high) return Infinity;
    high = low + 0.25;
    for (let i = 0; i < 8; ++i) {
        const middle = (low + high) / 2;
        on_front(middle) ? low = middle : high = middle;
    }
    return 2 ** low;
}

/** A control with a slider whose value is a power of 2. */
function make_slider(label, [low, high], step, power, describe, on_change) {
    const output = make("output", {}, describe(power));
    const input = make("input", {type: "range", min: low, max: high, step, "aria-valuetext": describe(power)});
    input.value = power;
    const set = value => {
        input.value = value;
        output.value = describe(Number(input.value));
        input.setAttribute("aria-valuetext", output.value);
    };
    input.addEventListener("input", () => { set(input.value), on_change(Number(input.value)); });
    return {element: make("label", {}, label + " ", input, output), set, input};
}

/** The map of one scene. */
class TradeMap {
    constructor(place) {
        this.place = place;
        this.data = JSON.parse(place.querySelector("script").textContent);
        this.edge_power = Math.log2(Math.sqrt(this.data.width * this.data.height));
        this.device = this.data.devices[0];
        this.state = {raster: 0, period: 0, edge: this.edge_power, rest: false, max_flip: this.data.max_flip};
        const names = this.data.devices.map((device, i) => make("option", {value: String(i)}, device.name));
        this.select = make("select", {}, ...names);
        this.select.addEventListener("change", () => { this.device = this.data.devices[this.select.value], this.show(); });
        const set = name => power => { this.state[name] = power, this.show(); };
        const factor = power => "×" + Number((2 ** power).toPrecision(3));
        const frames = power => `${Number((2 ** power).toPrecision(2))}`;
        const pixels = power => `${Math.round(2 ** power)}²`;
        this.sliders = {
            raster: make_slider("Raster work costs", kRasterPowers, 0.25, 0, factor, set("raster")),
            period: make_slider("Frames between captures", kPeriodPowers, 0.25, 0, frames, set("period")),
            edge: make_slider("Picture", kEdgePowers, 0.25, this.edge_power, pixels, set("edge")),
        };
        const rest = make("input", {type: "checkbox"});
        rest.addEventListener("change", () => { this.state.rest = rest.checked, this.show(); });
        const limits = [...new Set([0.005, 0.01, 0.02, 0.05, 0.1, 0.2, this.data.max_flip])].sort((a, b) => a - b);
        this.limit = make("select", {}, ...limits.map(x => make("option", {value: String(x), selected: x === this.data.max_flip}, String(x))));
        this.limit.addEventListener("change", () => { this.state.max_flip = Number(this.limit.value), this.show(); });
        this.answer = make("p", {className: "answer", "aria-live": "polite"});
        this.source = make("p", {className: "note"});
        this.body = make("tbody");
        this.maps = [["period", "Frames between captures", kPeriodPowers], ["edge", "Edge of the picture, pixels", kEdgePowers]]
            .map(([axis, title, powers]) => this.make_map(axis, title, powers));
        this.legend = make("ul", {className: "legend"});
        place.replaceChildren(
            make("div", {className: "controls"}, make("label", {}, "Device ", this.select), this.sliders.raster.element,
                this.sliders.period.element, make("label", {}, rest, " at rest"), this.sliders.edge.element,
                make("label", {}, "FLIP at most ", this.limit)),
            this.answer, make("div", {className: "panels"}, ...this.maps.map(({figure}) => figure)), this.legend,
            make("p", {className: "note"}, "Colour: the fastest row within the FLIP. Hatched: another row is fastest at the " +
                "other ends of the ranges of costs. The cross is the chosen point; a click or the arrow keys move it."),
            make("div", {className: "scroll", tabIndex: 0, role: "region", "aria-label": "Rows at the chosen point"},
                make("table", {}, make("thead", {}, make("tr", {}, ...["row", "ms", "FLIP", "front", "raster may be dearer by"]
                    .map((name, i) => make("th", {scope: "col", className: i === 0 ? "text" : ""}, name)))), this.body)),
            this.source);
        this.show();
        place.dataset.ready = "1";
    }

    make_map(axis, title, powers) {
        const canvas = make("canvas", {width: 480, height: 360, tabIndex: 0, role: "img"});
        const move = event => {
            const box = canvas.getBoundingClientRect();
            const across = (event.clientX - box.left) / box.width, up = 1 - (event.clientY - box.top) / box.height;
            this.set_point(axis, powers[0] + across * (powers[1] - powers[0]),
                kRasterPowers[0] + up * (kRasterPowers[1] - kRasterPowers[0]));
        };
        canvas.addEventListener("pointerdown", event => { canvas.setPointerCapture(event.pointerId), move(event); });
        canvas.addEventListener("pointermove", event => { if (event.buttons & 1) move(event); });
        canvas.addEventListener("keydown", event => {
            const [x, y] = {ArrowLeft: [-0.25, 0], ArrowRight: [0.25, 0], ArrowUp: [0, 0.25], ArrowDown: [0, -0.25]}[event.key] ?? [];
            if (x === undefined) return;
            event.preventDefault();
            this.set_point(axis, this.state[axis] + x, this.state.raster + y);
        });
        const ticks = (className, [low, high], step, write) => make("div", {className, "aria-hidden": "true"},
            ...Array.from({length: (high - low) / step + 1}, (_, i) => make("span", {}, write(low + i * step))));
        const figure = make("figure", {className: "map-figure"},
            ticks("up", kRasterPowers, 2, power => power < 0 ? `×1/${2 ** -power}` : `×${2 ** power}`), canvas,
            ticks("across", powers, 1, power => String(2 ** power)), make("figcaption", {}, `${title}; up: costs of raster work`));
        return {axis, title, powers, canvas, figure};
    }

    set_point(axis, power, raster) {
        const clamp = (x, [low, high]) => Math.min(Math.max(x, low), high);
        this.state[axis] = clamp(power, axis === "edge" ? kEdgePowers : kPeriodPowers);
        this.state.raster = clamp(raster, kRasterPowers);
        if (axis === "period" && this.state.rest) this.state.rest = this.place.querySelector("input[type=checkbox]").checked = false;
        this.sliders[axis].set(this.state[axis]), this.sliders.raster.set(this.state.raster);
        this.show();
    }

    /** Returns the point of the sliders, with some of the state replaced. */
    point(change = {}) {
        const {raster, period, edge, rest, max_flip} = {...this.state, ...change};
        return {raster: 2 ** raster, period: rest ? Infinity : 2 ** period, pixels: 4 ** (edge - this.edge_power), max_flip};
    }

    colour(index) {
        return index < 0 ? kNone : kPalette[index % kPalette.length];
    }

    show() {
        const {data, device} = this, point = this.point(), rows = find_rows(data, device, point);
        const best = find_best(data, device, point);
        const traced = rows.filter(({index, flip}) => data.rows[index].is_traced && flip <= point.max_flip).sort((a, b) => a.ms - b.ms)[0];
        const when = this.state.rest ? "at rest" : point.period === 1 ? "with captures drawn in each frame" :
            `with captures drawn each ${Number(point.period.toPrecision(2))} frames`;
        this.answer.textContent = best < 0 ? `No row has a FLIP of at most ${point.max_flip}.` :
            `On ${device.name}, ${when}: ${data.rows[best].label}, ${format_ms(rows[best].ms)} ms` +
            (traced && traced.index !== best ? `; ray traced: ${data.rows[traced.index].label}, ${format_ms(traced.ms)} ms.` : ".");
        const has_raster = device.units.some(({kind}) => data.kinds[kind].is_raster);
        this.source.textContent = `Costs: ${device.origin}.${device.note ? " " + device.note : ""}` + (has_raster ? "" :
            " They have no cost of raster work, which is part of the costs of passes and frames; the slider changes nothing.");
        this.body.replaceChildren(...rows.slice().sort((a, b) => a.ms - b.ms).map(({index, ms, flip, front}) => {
            const row = data.rows[index], ends = ["rays", "raster"].map(bound => predict(data, device, row, point, bound));
            const low = Math.min(ms, ...ends), high = Math.max(ms, ...ends);
            return make("tr", {className: front ? "front" : ""}, make("th", {scope: "row", className: "text"}, row.label),
                make("td", {}, format_ms(ms) + (low < high ? ` [${format_ms(low)}–${format_ms(high)}]` : "")),
                make("td", {}, String(Number(flip.toPrecision(3)))), make("td", {}, front ? "yes" : "no"),
                make("td", {}, front ? format_factor(find_margin(data, device, point, index)) : "–"));
        }));
        const seen = new Set(this.maps.flatMap(map => this.draw_map(map)));
        this.legend.replaceChildren(...[...seen].sort((a, b) => a - b).map(index => make("li", {},
            make("span", {style: "background:" + this.colour(index)}), index < 0 ? "no row" : data.rows[index].label)));
    }

    /** Draws a map. Returns the indices of the rows that are best somewhere on it. */
    draw_map({axis, title, powers, canvas}) {
        const pen = canvas.getContext("2d"), columns = kSteps.period, lines = kSteps.raster, seen = new Set();
        const width = canvas.width / columns, height = canvas.height / lines;
        pen.clearRect(0, 0, canvas.width, canvas.height);
        for (let x = 0; x < columns; ++x)
            for (let y = 0; y < lines; ++y) {
                const across = powers[0] + (x + 0.5) / columns * (powers[1] - powers[0]);
                const raster = kRasterPowers[1] - (y + 0.5) / lines * (kRasterPowers[1] - kRasterPowers[0]);
                const point = this.point({[axis]: across, raster, ...axis === "period" && {rest: false}});
                const best = find_best(this.data, this.device, point);
                seen.add(best);
                pen.fillStyle = this.colour(best);
                pen.fillRect(x * width, y * height, width + 0.5, height + 0.5);
                if (find_best(this.data, this.device, point, "rays") === find_best(this.data, this.device, point, "raster")) continue;
                pen.strokeStyle = "#0007";
                pen.beginPath();
                pen.moveTo(x * width, (y + 1) * height), pen.lineTo((x + 1) * width, y * height);
                pen.stroke();
            }
        const at = [(this.state[axis] - powers[0]) / (powers[1] - powers[0]) * canvas.width,
            (kRasterPowers[1] - this.state.raster) / (kRasterPowers[1] - kRasterPowers[0]) * canvas.height];
        for (const [colour, line] of [["#fff", 5], ["#000", 2]]) {
            pen.strokeStyle = colour, pen.lineWidth = line;
            pen.beginPath();
            pen.moveTo(at[0] - 8, at[1]), pen.lineTo(at[0] + 8, at[1]), pen.moveTo(at[0], at[1] - 8), pen.lineTo(at[0], at[1] + 8);
            pen.stroke();
        }
        pen.lineWidth = 1;
        canvas.setAttribute("aria-label", `Map: ${title} across, costs of raster work up. ${this.answer.textContent} Arrow keys move the point.`);
        return [...seen];
    }
}

for (const place of document.querySelectorAll(".map")) place.map = new TradeMap(place);
globalThis.catoptric_map = {predict, find_rows, find_best, find_margin};
})();
