// Error against time of a run that is going on, on logarithmic axes. The browser draws it:
// only to start gnuplot, which draws the plots of reports, takes more of the run's time than
// all else that a look needs.

const PLOT = {width: 1160, height: 420, left: 88, right: 1136, top: 14, low: 362};
const CURVES = [ // of points [wall, by bars, measured]
    {name: "by the run’s own error bars", value: 1, colour: 4, mark: "●"},
    {name: "against the reference", value: 2, colour: 10, mark: "■"},
];
const SLOPE = {name: "slope −1, as of independent samples", colour: 3, mark: "━"};

// An axis from lo to hi on the picture's from..to, and the numbers beside it.
function logarithmicAxis(lo, hi, from, to) {
    const decades = Math.log10(hi / lo);
    const steps = decades < 0.3 ? [1, 1.1, 1.2, 1.3, 1.5, 1.7, 2, 2.3, 2.6, 3, 3.5, 4, 4.6, 5.3, 6, 7, 8, 9]
        : decades < 0.8 ? [1, 1.5, 2, 3, 4, 5, 6, 8]
        : decades < 3 ? [1, 2, 5] : [1];
    const tics = [];
    for (let e = Math.floor(Math.log10(lo)); e <= Math.log10(hi); e++)
        for (const step of steps) tics.push(Number((step * 10 ** e).toPrecision(3)));
    return {
        lo, hi,
        at: (value) => (from + (to - from) * Math.log10(value / lo) / decades).toFixed(1),
        tics: tics.filter((tic) => tic >= lo && tic <= hi),
    };
}

function plotGrid({x, y}) {
    const {left, right, top, low, height} = PLOT;
    const line = (from, to, colour) =>
        `<path d="M${from}L${to}" stroke="var(--plot-${colour})" fill="none"/>`;
    const words = (place, content, anchor = "middle") =>
        `<text ${place} fill="var(--plot-1)" font-size="14" text-anchor="${anchor}">${content}</text>`;
    return [
        ...x.tics.map((tic) => line([x.at(tic), low], [x.at(tic), top], 2) +
            words(`x="${x.at(tic)}" y="${low + 20}"`, tic)),
        ...y.tics.map((tic) => line([left, y.at(tic)], [right, y.at(tic)], 2) +
            words(`x="${left - 8}" y="${Number(y.at(tic)) + 5}"`, tic, "end")),
        line([left, low], [right, low], 1), line([left, low], [left, top], 1),
        words(`x="${(left + right) / 2}" y="${height - 12}"`, "wall time of rendering [s]"),
        words(`transform="translate(18 ${(top + low) / 2}) rotate(-90)"`, "relMSE"),
    ].join("");
}

function plotCurve({x, y}, points, {value, colour}) {
    const places = points.filter((p) => p[value] > 0).map((p) => [x.at(p[0]), y.at(p[value])]);
    const dots = places.map(([cx, cy]) => `<circle cx="${cx}" cy="${cy}" r="3"/>`);
    return `<polyline fill="none" stroke="var(--plot-${colour})" stroke-width="2" ` +
        `points="${places.join(" ")}"/><g fill="var(--plot-${colour})">${dots.join("")}</g>`;
}

// From the upper left corner to where it leaves the plot; the error times the time is `product`.
function plotSlope({x, y}, product) {
    const end = Math.min(x.hi, product / y.lo);
    return `<path d="M${x.at(x.lo)} ${y.at(product / x.lo)}L${x.at(end)} ${y.at(product / end)}" ` +
        `stroke="var(--plot-${SLOPE.colour})" stroke-width="1.2" stroke-dasharray="6 4" fill="none"/>`;
}

// The plot with its legend; nothing, if there is no error to draw.
function plotHtml(points) {
    const curves = CURVES.filter((curve) => points.some((p) => p[curve.value] > 0));
    const values = curves.flatMap((curve) => points.map((p) => p[curve.value])).filter((v) => v > 0);
    if (!values.length) return "";
    const walls = points.map((p) => p[0]), least = Math.min(...walls), most = Math.max(...values);
    const axes = {
        x: logarithmicAxis(least / 1.05, Math.max(...walls) * 1.05, PLOT.left, PLOT.right),
        y: logarithmicAxis(Math.min(...values) / 1.3, most * 1.3, PLOT.low, PLOT.top),
    };
    const drawn = [...curves.map((curve) => plotCurve(axes, points, curve)), plotSlope(axes, least * most)];
    const entries = [...curves, SLOPE].map(({name, colour, mark}, i) =>
        `<li data-series="${i}"><span class="mark" aria-hidden="true" ` +
        `style="color: var(--plot-${colour})">${mark}</span> ${name}</li>`);
    return `<div class="panel wide"><h4 id="plot0-title">Error against time</h4>` +
        `<svg viewBox="0 0 ${PLOT.width} ${PLOT.height}" role="img" aria-labelledby="plot0-title">` +
        `<g>${plotGrid(axes)}${drawn.map((one, i) => `<g data-series="${i}">${one}</g>`).join("")}</g></svg>` +
        `<ul class="legend">${entries.join("")}</ul></div>`;
}
