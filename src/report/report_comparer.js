// Comparers: two pictures of a scene, chosen by the reader, one over the other.

const VIEWS = ["flip", "side", "slide", "difference"];

const format = (x) => (Number.isFinite(x) ? x.toPrecision(4) : String(x));

class Comparer {
    constructor(element, indices) {
        this.element = element;
        this.indices = indices; // of pictures, all of one size
        this.showsB = false;    // in the view "flip"
        this.probe = null;      // pixel under the pointer, or moved by keys
        this.shown = new Map(); // tone-mapped pictures at the exposure of now
        const find = (name) => element.querySelector(`.${name}`);
        for (const name of ["a", "b", "swap", "exposure", "ev", "reset", "zoom", "stage",
            "wipe", "measure", "range", "rangeOut", "readout", "scaleLow", "scaleHigh"])
            this[name] = find(name);
        this.canvases = [...element.querySelectorAll("canvas")];
        this.captions = [...element.querySelectorAll("figcaption")];
        this.figures = [...element.querySelectorAll(".stage figure")];
        this.probes = [...element.querySelectorAll(".probe")];
        this.views = [...element.querySelectorAll(".views input")];
        this.fill();
        this.listen();
    }

    // --- set up --------------------------------------------------------------------

    fill() {
        for (const select of [this.a, this.b])
            for (const index of this.indices) {
                const {name, biased} = pictures[index];
                select.append(new Option(name + (biased ? " (biased)" : ""), index));
            }
        const reference = this.indices.findIndex((index) => pictures[index].isReference);
        this.a.selectedIndex = reference === 0 && this.indices.length > 1 ? 1 : 0;
        this.b.selectedIndex = Math.max(reference, 0);
        if (reference < 0 && this.indices.length > 1) this.b.selectedIndex = 1;
        for (const view of this.views) view.name = `view-${this.element.id}`;
    }

    listen() {
        const redraw = () => this.draw();
        for (const part of [this.a, this.b, this.measure])
            part.addEventListener("change", redraw);
        for (const view of this.views) view.addEventListener("change", redraw);
        this.zoom.addEventListener("change", () => this.resize());
        this.wipe.addEventListener("input", redraw);
        this.range.addEventListener("input", redraw);
        this.exposure.addEventListener("input", () => this.expose(0));
        this.reset.addEventListener("click", () => {
            this.exposure.value = 0;
            this.expose(0);
        });
        this.swap.addEventListener("click", () => this.exchange());
        this.stage.addEventListener("keydown", (event) => this.key(event));
        for (const canvas of this.canvases) {
            // A picture that moves under a pointer at rest is no wish to read there.
            canvas.addEventListener("pointermove", (event) => {
                if (event.movementX || event.movementY) this.point(canvas, event);
            });
            canvas.addEventListener("pointerdown", (event) => this.press(canvas, event));
        }
        this.stage.addEventListener("pointerleave", () => this.aim(null));
        new ResizeObserver(() => this.resize()).observe(this.stage);
    }

    // --- what is asked for -----------------------------------------------------------

    get view() {
        return this.views.find((view) => view.checked).value;
    }

    setView(name) {
        for (const view of this.views) view.checked = view.value === name;
        this.draw();
    }

    exchange() {
        [this.a.selectedIndex, this.b.selectedIndex] =
            [this.b.selectedIndex, this.a.selectedIndex];
        this.draw();
    }

    flip() {
        this.showsB = !this.showsB;
        if (this.view === "flip") this.draw();
        else this.setView("flip");
    }

    expose(steps) {
        if (steps) this.exposure.value = Number(this.exposure.value) + steps;
        this.shown.clear();
        this.draw();
    }

    key(event) {
        const moves = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1],
            ArrowDown: [0, 1]};
        const step = Number(this.exposure.step);
        const actions = {
            " ": () => this.flip(), f: () => this.flip(), x: () => this.exchange(),
            "+": () => this.expose(step), "=": () => this.expose(step),
            "-": () => this.expose(-step),
            0: () => this.reset.click(),
            z: () => this.zoomBy(1), Z: () => this.zoomBy(-1),
            Escape: () => this.aim(null),
        };
        VIEWS.forEach((name, i) => (actions[i + 1] = () => this.setView(name)));
        if (event.ctrlKey || event.altKey || event.metaKey) return;
        if (event.key in moves) this.move(moves[event.key], event.shiftKey ? 10 : 1);
        else if (event.key in actions) actions[event.key]();
        else return;
        event.preventDefault();
    }

    zoomBy(step) {
        const last = this.zoom.options.length - 1;
        this.zoom.selectedIndex =
            Math.min(Math.max(this.zoom.selectedIndex + step, 0), last);
        this.resize();
    }

    // --- the pixel that is read ------------------------------------------------------

    get size() {
        const {width, height} = pictures[this.indices[0]];
        return {width, height};
    }

    point(canvas, event) {
        const box = canvas.getBoundingClientRect(), {width, height} = this.size;
        const x = Math.floor((event.clientX - box.left) / box.width * width);
        const y = Math.floor((event.clientY - box.top) / box.height * height);
        this.aim({x: Math.min(Math.max(x, 0), width - 1),
            y: Math.min(Math.max(y, 0), height - 1)});
        if (this.view === "slide" && event.buttons & 1) this.wipeTo(x / width);
    }

    press(canvas, event) {
        if (this.view === "slide") canvas.setPointerCapture(event.pointerId);
        this.point(canvas, event);
    }

    wipeTo(share) {
        this.wipe.value = 100 * share;
        this.draw();
    }

    move([x, y], by) {
        const {width, height} = this.size;
        const at = this.probe ?? {x: width >> 1, y: height >> 1};
        this.aim({x: Math.min(Math.max(at.x + by * x, 0), width - 1),
            y: Math.min(Math.max(at.y + by * y, 0), height - 1)});
    }

    aim(probe) {
        this.probe = probe;
        this.placeProbes();
        this.read();
    }

    placeProbes() {
        this.probes.forEach((mark, i) => {
            mark.hidden = !this.probe;
            if (!this.probe) return;
            const canvas = this.canvases[i], unit = canvas.clientWidth / this.size.width;
            mark.style.left = `${canvas.offsetLeft + unit * this.probe.x}px`;
            mark.style.top = `${canvas.offsetTop + unit * this.probe.y}px`;
            mark.style.width = mark.style.height = `${unit}px`;
        });
    }

    // Radiance of A, B and the reference.
    async read() {
        if (!this.probe) {
            this.readout.textContent = "";
            return;
        }
        const {x, y} = this.probe, i = y * this.size.width + x;
        const lines = [["A", Number(this.a.value)], ["B", Number(this.b.value)]];
        const reference = this.referenceOf(Number(this.a.value));
        if (reference >= 0) lines.push(["reference", reference]);
        const texts = [];
        for (const [name, index] of lines) {
            const v = await valuesOf(index);
            const rgb = [0, 1, 2].map((c) => format(v[3 * i + c]).padStart(10)).join(" ");
            texts.push(`${name.padEnd(9)} ${rgb}   Y ${format(luminance(v, i)).padStart(10)}`);
        }
        if (this.probe && this.probe.x === x && this.probe.y === y)
            this.readout.textContent = `pixel ${x}, ${y}  (R G B, luminance Y)\n${texts.join("\n")}`;
    }

    referenceOf(index) {
        return pictures[index].isReference ? index : pictures[index].reference;
    }

    // --- drawing ---------------------------------------------------------------------

    // The pictures are others, of the same number.
    renew() {
        this.shown.clear();
        for (const select of [this.a, this.b])
            for (const option of select.options) option.text = pictures[option.value].name;
        this.draw();
    }

    // All are shown alike: by what suits the reference.
    get scale() {
        const reference = this.indices.find((index) => pictures[index].isReference);
        const base = pictures[reference ?? this.indices[0]].scale;
        return base * 2 ** Number(this.exposure.value);
    }

    async bytesOf(index) {
        if (!this.shown.has(index))
            this.shown.set(index, toneMapped(await valuesOf(index), this.scale));
        return this.shown.get(index);
    }

    paint(which, bytes, caption) {
        const {width, height} = this.size, canvas = this.canvases[which];
        if (canvas.width !== width || canvas.height !== height) {
            canvas.width = width;
            canvas.height = height;
        }
        // In memory, where the bytes come from, not in the graphics card.
        const context = canvas.getContext("2d", {willReadFrequently: true});
        context.putImageData(new ImageData(bytes, width, height), 0, 0);
        this.captions[which].textContent = caption;
        canvas.setAttribute("aria-label", caption);
    }

    async paintDifference(which, index, name) {
        const reference = this.referenceOf(index);
        const other = reference >= 0 ? reference : Number(this.b.value);
        const range = 2 ** Number(this.range.value);
        const bytes = difference(await valuesOf(index), await valuesOf(other),
            this.measure.value, range);
        this.paint(which, bytes, `${name} \u2212 ${reference >= 0 ? "reference" : "B"}: ` +
            this.nameOf(index));
    }

    async paintWipe(a, b) {
        const {width, height} = this.size, edge = Math.round(this.wipe.value / 100 * width);
        const left = await this.bytesOf(a), right = await this.bytesOf(b);
        const bytes = left.slice();
        for (let y = 0; y < height; y++) {
            const from = 4 * (y * width + edge), to = 4 * (y + 1) * width;
            bytes.set(right.subarray(from, to), from);
        }
        this.paint(0, bytes, `A | B: ${this.nameOf(a)} | ${this.nameOf(b)}`);
    }

    async paintView(view, a, b) {
        const [first, second] = [[a, "A"], [b, "B"]];
        const caption = ([index, name]) => `${name}: ${this.nameOf(index)}`;
        if (view === "difference") {
            await this.paintDifference(0, a, "A");
            if (!this.figures[1].hidden) await this.paintDifference(1, b, "B");
        } else if (view === "slide") {
            await this.paintWipe(a, b);
        } else if (view === "side") {
            this.paint(0, await this.bytesOf(a), caption(first));
            this.paint(1, await this.bytesOf(b), caption(second));
        } else {
            const shown = this.showsB ? second : first;
            this.paint(0, await this.bytesOf(shown[0]), caption(shown));
        }
    }

    nameOf(index) {
        const {name, biased, relmse} = pictures[index];
        return name + (biased ? ", biased" : "") +
            (relmse === null ? "" : ` (relMSE ${relmse.toPrecision(3)})`);
    }

    labelControls(view) {
        const ev = Number(this.exposure.value), range = 2 ** Number(this.range.value);
        const text = (x) => x.toPrecision(2).replace(/\.0+$/, "");
        const signed = this.measure.value === "signed";
        this.ev.textContent = `${ev > 0 ? "+" : ev < 0 ? "\u2212" : ""}${Math.abs(ev).toFixed(2)} EV`;
        this.rangeOut.textContent = text(range);
        this.scaleLow.textContent = signed ? `\u2212${text(range)}` : "0";
        this.scaleHigh.textContent = text(range);
        this.element.dataset.view = view;
        this.element.dataset.measure = this.measure.value;
    }

    // One at a time; what is asked for meanwhile is drawn once, as it then stands.
    draw() {
        this.waiting ??= Promise.resolve(this.drawing).then(() => {
            this.waiting = undefined;
            this.drawing = this.drawNow();
            return this.drawing;
        });
        return this.waiting;
    }

    async drawNow() {
        const view = this.view, a = Number(this.a.value), b = Number(this.b.value);
        const two = view === "side" || (view === "difference" &&
            this.referenceOf(a) >= 0 && this.referenceOf(b) !== b);
        this.labelControls(view);
        this.figures[1].hidden = !two;
        try {
            await this.paintView(view, a, b);
        } catch (error) {
            this.captions[0].textContent = `The picture cannot be shown: ${error.message}`;
        }
        this.resize();
        this.read();
        this.element.dataset.drawn = Number(this.element.dataset.drawn ?? 0) + 1;
    }

    // "fit": as wide as there is room for, but no larger than fourfold.
    resize() {
        const {width} = this.size, count = this.figures[1].hidden ? 1 : 2;
        const room = (this.stage.clientWidth - 16 * (count + 1)) / count;
        const fit = Math.min(room / width, 4, 0.72 * innerHeight / this.size.height);
        const factor = this.zoom.value === "fit" ? Math.max(fit, 0.1) : Number(this.zoom.value);
        for (const canvas of this.canvases) canvas.style.width = `${factor * width}px`;
        this.placeProbes();
    }
}

function startComparer(element) {
    const template = document.getElementById("comparer");
    element.append(template.content.cloneNode(true));
    element.comparer = new Comparer(element, element.dataset.pictures.split(" ").map(Number));
}

// Pictures are unpacked when their comparer comes near the window.
function startComparers() {
    const near = new IntersectionObserver((entries) => {
        for (const entry of entries)
            if (entry.isIntersecting) {
                near.unobserve(entry.target);
                entry.target.comparer.draw();
            }
    }, {rootMargin: "400px"});
    for (const element of document.querySelectorAll("[data-pictures]")) {
        startComparer(element);
        near.observe(element);
    }
}

startComparers();
