// Charts of pages. The library uPlot scales, draws the axes and finds the pointer. This script adds what uPlot lacks: marks
// of rows with intervals in both directions, a lane for values of 0 on logarithmic axes, names beside marks and lines,
// values beside the pointer, and keys. A chart is `<div class="chart">` with its data as JSON (report/chart.hpp).
"use strict";
(() => {
const kFontPixels = 12, kReach = 30; // the pointer finds points within so many CSS pixels
const kPrintWidths = {rows: 600, lines: 290}; // CSS pixels of charts on paper, by kind
const kPrintSharpness = 3; // canvas pixels for each of them

const root = document.documentElement;
const colour = name => getComputedStyle(root).getPropertyValue(name).trim();
const format_number = x => x === null || x === undefined ? "–" : String(Number(x.toPrecision(4)));
const is_known = x => Number.isFinite(x);

/** Makes an element with properties and children. */
function make(tag, properties = {}, ...children) {
    const element = Object.assign(document.createElement(tag), properties);
    element.append(...children);
    return element;
}

/**
 * Returns the limits of an axis. A logarithmic axis with a value of 0 or less has a lane for such values, below `floor`,
 * whose middle is `lane`.
 */
function find_range(values, log) {
    const known = values.filter(is_known), positive = known.filter(x => x > 0);
    if (!log) {
        const low = Math.min(0, ...known), high = Math.max(...known, 0), air = 0.06 * (high - low || 1);
        return {low: Math.min(...known) > 0 ? 0 : low - air, high: high + air};
    }
    let [low, high] = positive.length ? [Math.min(...positive), Math.max(...positive)].map(Math.log10) : [-3, 0];
    const air = Math.max(0.08 * (high - low), (0.6 - (high - low)) / 2);
    low -= air, high += air;
    if (positive.length === known.length) return {low: 10 ** low, high: 10 ** high};
    const lane = 0.14 * (high - low);
    return {low: 10 ** (low - lane), high: 10 ** high, lane: 10 ** (low - lane / 2), floor: 10 ** low,
        lane_name: known.some(x => x < 0) ? "≤ 0" : "0"};
}

/**
 * Returns 1, 2 and 5 times the powers of ten within the limits of an axis, or powers alone if more than `most` fit. The
 * lane of values of 0 has a tick, too.
 */
function list_log_ticks({low, high, lane, floor = low}, most) {
    const first = Math.floor(Math.log10(floor)), last = Math.ceil(Math.log10(high));
    for (const steps of [[1, 2, 5], [1, 3], [1]]) {
        const ticks = [];
        for (let power = first; power <= last; ++power)
            ticks.push(...steps.map(step => Number(`${step}e${power}`)).filter(x => x >= floor && x <= high));
        if (ticks.length > most && steps.length > 1) continue;
        return [...lane ? [lane] : [], ...ticks.filter((_, i) => i % Math.ceil(ticks.length / most) === 0)];
    }
}

/** A chart. A kind of chart is a class with `arrange`, `draw`, `describe` and `step`. */
class Chart {
    constructor(place) {
        this.place = place;
        this.data = JSON.parse(place.querySelector("script").textContent);
        this.log = {x: this.data.log_x, y: this.data.log_y};
        this.sharpness = 1;
        this.box = make("div", {className: "chart-box", tabIndex: 0});
        this.box.setAttribute("role", "group");
        this.box.setAttribute("aria-label", this.data.says + ". Arrow keys choose a point, and its values are told.");
        this.tip = make("div", {className: "chart-tip"}); // empty: not shown, but screen readers watch it
        this.tip.setAttribute("role", "status");
        this.place.replaceChildren(...this.make_controls(), this.box);
        this.box.addEventListener("keydown", event => this.on_key(event));
        this.box.addEventListener("blur", () => this.choose(null));
        new ResizeObserver(() => this.fit()).observe(this.box);
        place.chart = this; // for tests
    }

    make_controls() { return []; }

    /** Makes or fits the chart once its box has a size. A box on a hidden tab has none. */
    fit() {
        const width = this.box.clientWidth;
        if (width === 0 || this.sharpness !== 1) return;
        if (this.plot?.width !== width) this.build(width);
    }

    /** Draws the chart again, `width` CSS pixels wide. */
    build(width = this.box.clientWidth) {
        this.plot?.destroy();
        this.active = this.key = null;
        this.tip.replaceChildren();
        const k = this.sharpness, {x, y, series, data, right} = this.arrange(width * k);
        // uPlot draws later, and perhaps after the next call of `build`. Its functions must not see the state of that call.
        const log = {...this.log};
        const ranges = this.ranges = {x: x.range ?? find_range(x.values, log.x), y: find_range(y.values, log.y)};
        const place = value => !is_known(value) ? null : log.y && value <= 0 ? ranges.y.lane : value;
        this.placed = [data[0], ...data.slice(1).map(values => values.map(place))];
        const font = `${kFontPixels * k}px system-ui, sans-serif`;
        const axis = (name, label, side, ticks) => ({
            scale: name, side, label, font, labelFont: font, stroke: () => colour("--soft"), gap: 6 * k, labelSize: 20 * k,
            size: side === 2 ? 26 * k : (plot, values) => (14 + 7 * Math.max(...(values ?? [""]).map(text => text.length))) * k,
            grid: {stroke: () => colour("--line"), width: k}, ticks: {show: false}, space: (side === 2 ? 50 : 40) * k,
            ...log[name] || ticks ? {filter: (plot, splits) => splits,
                splits: () => [...ticks ?? list_log_ticks(ranges[name], name === "x" ? width / 60 : 12)]} : {},
            values: (plot, splits) => splits.map(tick => ranges[name].lane === tick ? ranges[name].lane_name : format_number(tick)),
        });
        const scale = name => ({time: false, distr: log[name] ? 3 : 1, range: () => [ranges[name].low, ranges[name].high]});
        this.plot = new uPlot({
            width: width * k, height: Math.round(Math.min(Math.max(0.55 * width, 260), 520)) * k, padding: [12 * k, right, 0, 0],
            scales: {x: scale("x"), y: scale("y")}, series: [{}, ...series], legend: {show: false},
            axes: [axis("x", x.name, 2, x.ticks), axis("y", y.name, 3)],
            cursor: {
                x: false, y: false, drag: {x: false, y: false, setScale: false},
                points: {size: 16, width: 2, fill: "transparent", stroke: () => colour("--accent")},
                move: (plot, left, top) => {
                    this.active = this.key ?? this.find_nearest(left, top);
                    return [left, top];
                },
                dataIdx: (plot, series) => this.active?.series === series ? this.active.index : null,
            },
            hooks: {
                drawAxes: [plot => this.on_canvas(plot, pen => this.draw_lane(plot, pen))],
                draw: [plot => this.on_canvas(plot, (pen, unit) => this.draw(plot, pen, unit))],
                setCursor: [() => this.show_tip()],
            },
        }, this.placed, this.box);
        this.plot.root.style.zoom = 1 / k;
        this.plot.over.append(this.tip);
        this.plot.over.addEventListener("mousemove", () => { this.key = null; }, true);
        this.plot.over.addEventListener("click", () => this.active && this.act());
    }

    /** Calls `draw` with the context of the canvas and the number of its pixels in a CSS pixel; restores the context. */
    on_canvas(plot, draw) {
        if (plot !== this.plot) return; // replaced before it was drawn
        plot.ctx.save();
        const unit = uPlot.pxRatio * this.sharpness;
        plot.ctx.font = `${kFontPixels * unit}px system-ui, sans-serif`, plot.ctx.textBaseline = "middle";
        draw(plot.ctx, unit);
        plot.ctx.restore();
    }

    draw_lane(plot, pen) {
        if (!this.ranges.y.floor) return;
        const top = plot.valToPos(this.ranges.y.floor, "y", true), {left, width, height} = plot.bbox;
        pen.globalCompositeOperation = "destination-over"; // below the grid
        pen.fillStyle = colour("--tint"), pen.fillRect(left, top, width, plot.bbox.top + height - top);
    }

    /** Returns the position of a point on the plotting area in CSS pixels, or on the canvas in its pixels. */
    find_place(point, on_canvas = false) {
        return [this.plot.valToPos(this.placed[0][point.index], "x", on_canvas),
            this.plot.valToPos(this.placed[point.series][point.index], "y", on_canvas)];
    }

    /** Returns all points that are drawn, as {series, index}. */
    list_points() {
        return this.placed.slice(1).flatMap((values, i) => values.map((value, index) => ({series: i + 1, index, value})))
            .filter(point => point.value !== null);
    }

    find_nearest(left, top) {
        if (left < 0) return null;
        let nearest = null, least = kReach;
        for (const point of this.list_points()) {
            const [x, y] = this.find_place(point), distance = Math.hypot(x - left, y - top);
            if (distance < least) nearest = point, least = distance;
        }
        return nearest;
    }

    /** Chooses a point by key, or none. */
    choose(point) {
        this.key = point;
        const [left, top] = point ? this.find_place(point) : [-10, -10];
        this.plot?.setCursor({left, top});
    }

    show_tip() {
        const lines = this.active ? this.describe(this.active) : [];
        this.tip.replaceChildren(...lines.map((line, i) => make(i === 0 ? "strong" : "div", {}, line)));
        if (!this.active) return;
        const [x, y] = this.find_place(this.active), {offsetWidth, offsetHeight} = this.tip, {over} = this.plot;
        const left = x + 14 + offsetWidth <= over.clientWidth ? x + 14 : Math.max(x - 14 - offsetWidth, -over.offsetLeft);
        const top = Math.min(Math.max(y - offsetHeight / 2, 0), over.clientHeight - offsetHeight);
        this.tip.style.transform = `translate(${Math.round(left)}px, ${Math.round(top)}px)`;
    }

    /** Shows the chosen point elsewhere on the page. */
    act() {}

    on_key(event) {
        if (event.ctrlKey || event.altKey || event.metaKey || event.target !== this.box || !this.plot) return;
        const points = this.list_points();
        if (event.key === "Escape") this.choose(null);
        else if (["Enter", " "].includes(event.key)) this.active && this.act();
        else if (event.key === "Home" || event.key === "End") this.choose(points.at(event.key === "Home" ? 0 : -1));
        else if (event.key.startsWith("Arrow")) this.choose(this.active ? this.step(event.key, points) : points[0]);
        else return;
        event.preventDefault();
    }

    /** Draws the chart for paper and back: in the light theme, with sharper pixels. Paper also shows hidden tabs. */
    print(on) {
        const width = on ? Math.min(this.box.clientWidth || Infinity, kPrintWidths[this.data.kind]) : this.box.clientWidth;
        if (width === 0) return;
        this.sharpness = on ? kPrintSharpness : 1;
        this.build(width);
    }
}

/** Time of rows against one of their metrics. */
class RowsChart extends Chart {
    make_controls() {
        this.metric = 0;
        const metric = make("select", {}, ...this.data.metrics.map(({name}, i) => make("option", {value: i}, name)));
        metric.addEventListener("change", () => { this.metric = Number(metric.value), this.build(); });
        const switches = [["x", "Logarithmic time"], ["y", "Logarithmic values"]].map(([name, text]) => {
            const box = make("input", {type: "checkbox", checked: this.log[name]});
            box.addEventListener("change", () => { this.log[name] = box.checked, this.build(); });
            return make("label", {}, box, " " + text);
        });
        return [make("div", {className: "controls"}, make("label", {}, "Time against ", metric), ...switches)];
    }

    arrange() {
        const {time, metrics, rows, floor} = this.data, metric = metrics[this.metric];
        const known = rows.map((_, i) => i).filter(i => is_known(metric.values[i]));
        this.order = known.sort((a, b) => time.values[a] - time.values[b]); // row of each index of the chart
        this.is_first = metric.name.startsWith("FLIP over the mirrors"); // of which the front and the noise are
        const shown = column => this.order.map(i => column.values[i]);
        const values = shown(metric);
        return {x: {name: time.name, values: shown(time)},
            y: {name: metric.name, values: this.is_first && floor ? [...values, floor.value] : values},
            series: [{paths: () => null, points: {show: false}}], data: [shown(time), values], right: 24 * this.sharpness};
    }

    draw(plot, pen, unit) {
        const {left, top, width, height} = plot.bbox, {time, metrics, rows, curves, floor} = this.data;
        const places = new Map(this.order.map((row, index) => [row, this.find_place({series: 1, index}, true)]));
        const line = (stroke, points, dash = []) => {
            pen.strokeStyle = colour(stroke), pen.setLineDash(dash.map(x => x * unit));
            pen.beginPath();
            points.forEach(([x, y], i) => i === 0 ? pen.moveTo(x, y) : pen.lineTo(x, y));
            pen.stroke();
        };
        pen.beginPath(), pen.rect(left, top, width, height), pen.save(), pen.clip();
        pen.lineWidth = unit;
        if (this.is_first && floor) {
            const y = plot.valToPos(floor.value, "y", true);
            line("--other", [[left, y], [left + width, y]], [2, 4]);
            pen.fillStyle = colour("--soft"), pen.textAlign = "right", pen.fillText(floor.name, left + width - 4 * unit, y - 8 * unit);
        }
        for (const curve of curves) line("--other", curve.map(row => places.get(row)).filter(Boolean));
        pen.lineWidth = 1.5 * unit;
        if (this.is_first) this.draw_front(line, places, plot.bbox);
        for (const [row, [x, y]] of places) {
            const at = (value, axis) => plot.valToPos(this.log[axis] ? Math.max(value, this.ranges[axis].low) : value, axis, true);
            const [times, errors] = [time.intervals[row], metrics[this.metric].intervals[row]];
            if (times) line("--other", times.map(value => [at(value, "x"), y]));
            if (errors) line("--other", errors.map(value => [x, at(value, "y")]));
        }
        pen.restore(); // marks at an edge are whole
        pen.lineWidth = 1.5 * unit, pen.setLineDash([]);
        for (const [row, [x, y]] of places) this.draw_mark(pen, rows[row], x, y, unit);
        this.draw_labels(pen, places, plot.bbox, unit);
    }

    /** Draws the least error of all marks for each time as a staircase. No mark lies left of it and below. */
    draw_front(line, places, {left, top, width}) {
        const marks = [...places.values()].sort((a, b) => a[0] - b[0]);
        if (marks.length === 0) return;
        const stairs = [[marks[0][0], top]];
        for (const [x, y] of marks) if (y > stairs.at(-1)[1]) stairs.push([x, stairs.at(-1)[1]], [x, y]);
        line("--accent", [...stairs, [left + width, stairs.at(-1)[1]]], [5, 4]);
    }

    /** Draws a square for ray tracing, otherwise a disc. */
    draw_mark(pen, row, x, y, unit) {
        pen.strokeStyle = colour(row.front ? "--accent" : "--other");
        pen.fillStyle = colour(row.front ? "--accent" : "--card");
        pen.beginPath();
        row.traced ? pen.rect(x - 4.5 * unit, y - 4.5 * unit, 9 * unit, 9 * unit) : pen.arc(x, y, 5 * unit, 0, 7);
        pen.globalAlpha = row.hidden && this.is_first ? 0.25 : 1, pen.fill();
        pen.globalAlpha = 1, pen.stroke();
    }

    /** Draws the labels of rows where they cover no mark and no other label. Rows on the front come first. */
    draw_labels(pen, places, {left, top, width, height}, unit) {
        const high = 13 * unit, far = 9 * unit;
        const taken = [...places.values()].map(([x, y]) => [x - high / 2, y - high / 2, x + high / 2, y + high / 2]);
        const is_free = box => box[0] >= left && box[2] <= left + width && box[1] >= top && box[3] <= top + height &&
            !taken.some(other => box[0] < other[2] && other[0] < box[2] && box[1] < other[3] && other[1] < box[3]);
        pen.textAlign = "left", pen.lineJoin = "round";
        for (const row of [...places.keys()].sort((a, b) => this.data.rows[b].front - this.data.rows[a].front)) {
            const [x, y] = places.get(row), {label, name = label, front} = this.data.rows[row], wide = pen.measureText(name).width;
            if (!name) continue;
            const sides = front ? [x - far - wide, x + far] : [x + far, x - far - wide]; // no stairs lie on the left
            const box = [0, -1, 1].flatMap(rise => sides.map(at =>
                [at, y + (rise - 0.5) * high, at + wide, y + (rise + 0.5) * high])).find(is_free);
            if (!box) continue; // the label stands beside the pointer
            taken.push(box);
            pen.strokeStyle = colour("--card"), pen.lineWidth = 3 * unit;
            pen.fillStyle = colour("--ink");
            pen.strokeText(name, box[0], box[1] + high / 2), pen.fillText(name, box[0], box[1] + high / 2);
        }
    }

    describe({index}) {
        const {time, metrics, rows} = this.data, row = this.order[index], metric = metrics[this.metric];
        const tell = ({name, values, intervals}) => `${name}: ${format_number(values[row])}` +
            (intervals[row] ? ` (${intervals[row].map(format_number).join(" to ")})` : "");
        const {label, place, front, hidden} = rows[row];
        return [label, tell(time), tell(metric) + (hidden && this.is_first ? `, ${this.data.floor?.name}` : ""),
            ...place ? [`Place by time: ${place}`] : [], ...front ? ["On the front"] : []];
    }

    /** Returns the neighbour of the chosen row in the order of time (left, right) or of the values (down, up). */
    step(key, points) {
        const list = key === "ArrowLeft" || key === "ArrowRight" ? points : [...points].sort((a, b) => a.value - b.value);
        const at = list.findIndex(({index}) => index === this.active.index);
        return list[Math.min(Math.max(at + (key === "ArrowLeft" || key === "ArrowDown" ? -1 : 1), 0), list.length - 1)];
    }

    act() {
        const {picture} = this.data.rows[this.order[this.active.index]];
        if (picture) this.place.dispatchEvent(new CustomEvent("choose-picture", {bubbles: true, detail: picture}));
    }
}

/** Lines, whose names stand at their right ends. */
class LinesChart extends Chart {
    arrange(width) {
        const {x, x_name, x_ticks, y_name, lines} = this.data, k = this.sharpness;
        const ends = {low: x[0], high: x.at(-1) > x[0] ? x.at(-1) : x[0] + 1};
        return {x: {name: x_name, values: x, range: ends, ticks: x_ticks},
            y: {name: y_name, values: lines.flatMap(line => line.y)},
            series: lines.map((_, i) => ({stroke: () => colour("--accent"), width: 1.5 * k, points: {show: false},
                alpha: 0.3 + 0.7 * (i + 1) / lines.length})),
            data: [x, ...lines.map(line => x.map((_, i) => line.y[i] ?? null))],
            right: Math.min(14 * k + 7 * k * Math.max(...lines.map(line => line.name.length)), 0.4 * width)};
    }

    draw(plot, pen, unit) {
        const end = plot.bbox.left + plot.bbox.width, room = pen.canvas.width - end - 8 * unit;
        const names = this.data.lines.map(({name, y}, i) => ({name, y: is_known(y[this.data.x.length - 1])
            ? this.find_place({series: i + 1, index: this.data.x.length - 1}, true)[1] : null}));
        let free = Infinity;
        pen.fillStyle = colour("--soft"), pen.textAlign = "left";
        for (const {name, y} of names.filter(one => one.y !== null).sort((a, b) => b.y - a.y)) {
            free = Math.min(y, free - 13 * unit); // a name moves up if it would cover another
            pen.fillText(name, end + 6 * unit, free, room);
        }
    }

    describe({series, index}) {
        const {x, x_name, y_name, lines} = this.data, line = lines[series - 1];
        return [line.name, `${x_name}: ${format_number(x[index])}`, `${y_name}: ${format_number(line.y[index])}`];
    }

    /** Returns the next point of the same line (left, right), or that of the line beside it at the same x. */
    step(key, points) {
        const along = key === "ArrowLeft" || key === "ArrowRight";
        const list = points.filter(point => along ? point.series === this.active.series : point.index === this.active.index)
            .sort((a, b) => along ? a.index - b.index : a.value - b.value);
        const at = list.findIndex(({series, index}) => series === this.active.series && index === this.active.index);
        return list[Math.min(Math.max(at + (key === "ArrowLeft" || key === "ArrowDown" ? -1 : 1), 0), list.length - 1)];
    }
}

const charts = Array.from(document.querySelectorAll(".chart"), place =>
    new ({rows: RowsChart, lines: LinesChart}[JSON.parse(place.querySelector("script").textContent).kind])(place));
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => charts.forEach(chart => chart.plot?.redraw()));
const print = on => {
    root.classList.toggle("print", on);
    charts.forEach(chart => chart.print(on));
};
addEventListener("beforeprint", () => print(true));
addEventListener("afterprint", () => print(false));
})();
