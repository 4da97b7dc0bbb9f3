// What belongs to the page as a whole: light and dark, tables, figures.

// --- light and dark ------------------------------------------------------------------

const THEMES = ["system", "light", "dark"];

function keptTheme() {
    try {
        return localStorage.getItem("etalon-theme");
    } catch {
        return null; // not every browser lets a file keep something
    }
}

function setTheme(button, theme) {
    const root = document.documentElement;
    if (theme === "system") delete root.dataset.theme;
    else root.dataset.theme = theme;
    button.querySelector("span").textContent = theme;
    button.dataset.theme = theme;
    try {
        localStorage.setItem("etalon-theme", theme);
    } catch {
        // then it holds for this visit alone
    }
}

function startTheme() {
    const button = document.getElementById("theme");
    const kept = keptTheme();
    setTheme(button, THEMES.includes(kept) ? kept : "system");
    button.hidden = false;
    button.addEventListener("click", () => {
        const next = (THEMES.indexOf(button.dataset.theme) + 1) % THEMES.length;
        setTheme(button, THEMES[next]);
    });
}

// --- tables --------------------------------------------------------------------------

// Texts by the alphabet, but numbers in them by value: p_l=0.02 before p_l=0.1.
function compareTexts(a, b) {
    const split = (text) => text.toLowerCase().split(/(\d+(?:\.\d+)?)/);
    const x = split(a), y = split(b);
    for (let i = 0; i < Math.min(x.length, y.length); i++) {
        const order = i % 2 ? x[i] - y[i] : x[i].localeCompare(y[i], "en");
        if (order !== 0) return order;
    }
    return x.length - y.length;
}

// Numbers by value, what is none behind them, whichever way.
function compareCells(a, b, direction) {
    const x = a.dataset.value, y = b.dataset.value;
    if (a.classList.contains("number") || b.classList.contains("number")) {
        if (x === undefined || y === undefined)
            return (x === undefined) - (y === undefined);
        return direction * (Number(x) - Number(y));
    }
    return direction * compareTexts(a.textContent, b.textContent);
}

function sortBy(button) {
    const head = button.closest("th"), table = head.closest("table");
    const column = Number(button.dataset.column);
    const ascending = head.getAttribute("aria-sort") !== "ascending";
    for (const other of table.querySelectorAll("th[aria-sort]"))
        other.setAttribute("aria-sort", "none");
    head.setAttribute("aria-sort", ascending ? "ascending" : "descending");
    const body = table.tBodies[0];
    const rows = [...body.rows];
    rows.sort((a, b) =>
        compareCells(a.cells[column], b.cells[column], ascending ? 1 : -1));
    body.append(...rows);
}

function filterRows(input) {
    const table = document.getElementById(input.dataset.table);
    const words = input.value.toLowerCase().split(/\s+/).filter(Boolean);
    for (const row of table.tBodies[0].rows) {
        const text = row.textContent.toLowerCase();
        row.hidden = !words.every((word) => text.includes(word));
    }
}

function startTables() {
    for (const button of document.querySelectorAll("th button"))
        button.addEventListener("click", () => sortBy(button));
    for (const input of document.querySelectorAll("input.filter")) {
        input.parentElement.hidden = false;
        input.addEventListener("input", () => filterRows(input));
    }
}

// --- figures -------------------------------------------------------------------------

// What the legend's entry stands for is brought out while it has the pointer or focus.
function startFigures() {
    for (const panel of document.querySelectorAll(".panel")) {
        for (const entry of panel.querySelectorAll(".legend [data-series]")) {
            const mark = (on) => {
                panel.classList.toggle("singled", on);
                for (const part of panel.querySelectorAll("g[data-series]"))
                    part.classList.toggle(
                        "single", on && part.dataset.series === entry.dataset.series);
            };
            entry.tabIndex = 0;
            entry.addEventListener("pointerenter", () => mark(true));
            entry.addEventListener("pointerleave", () => mark(false));
            entry.addEventListener("focus", () => mark(true));
            entry.addEventListener("blur", () => mark(false));
        }
    }
}

startTheme();
startTables();
startFigures();
