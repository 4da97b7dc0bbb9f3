// The page of a run that is still going: it asks for the state of the run again and again,
// and for the pictures when there are newer ones. Both are scripts, which call the functions
// below: a page that is a file may load nothing else.

const DOCUMENTS = ["picture.js", "reference.js", "bars.js"];

const live = document.getElementById("live");
const comparer = document.getElementById("comparer-live");
let state = {pictures: [], ended: false}; // as last heard
const shown = DOCUMENTS.map(() => 0);     // numbers of the looks whose pictures are here

// Another run publishes there now: its pictures are counted anew.
function etalonState(heard) {
    if (state.run !== undefined && heard.run !== state.run) {
        location.reload();
        return;
    }
    state = heard;
}

function etalonPicture(index, number, [description], [base64]) {
    const id = `picture-${index}`;
    let element = document.getElementById(id);
    if (!element) {
        element = document.createElement("script");
        element.type = "application/octet-stream";
        element.id = id;
        document.body.append(element);
    }
    element.textContent = base64;
    pictures[index] = description;
    shown[index] = number;
}

// The settings of the comparer stay as the reader left them, unless there are more pictures.
function showPictures() {
    const indices = Object.keys(pictures).join(" ");
    if (comparer.dataset.pictures === indices) {
        comparer.comparer.renew();
        return;
    }
    comparer.replaceChildren();
    comparer.dataset.pictures = indices;
    startComparer(comparer);
    comparer.comparer.draw();
}

function load(name) {
    return new Promise((resolve, reject) => {
        const script = document.createElement("script");
        const end = (then) => () => {
            script.remove();
            then();
        };
        script.src = `${name}?${Date.now()}`;
        script.onload = end(resolve);
        script.onerror = end(reject);
        document.head.append(script);
    });
}

function showState() {
    const find = (id) => document.getElementById(id);
    find("status").textContent = state.status;
    if (!("summary" in state)) return;
    for (const id of ["verdict", "statistics"]) find(id).innerHTML = state[id];
    find("plot").innerHTML = plotHtml(state.points);
    find("summary").textContent = state.summary;
    startFigures();
}

async function loadPictures() {
    const newer = DOCUMENTS.filter((_, i) => state.pictures[i] > shown[i]);
    for (const name of newer) await load(name);
    if (newer.length) showPictures();
}

// True once there is nothing to wait for.
async function look() {
    const lost = document.getElementById("lost"), before = state.status;
    try {
        await load("live.js");
        if (state.status !== before) showState();
        await loadPictures();
        lost.hidden = true;
    } catch {
        lost.hidden = false;
        lost.textContent = "The run does not answer: it has ended, or the way to it is closed. " +
            "What it last told is below.";
    }
    live.dataset.shown = shown[0];
    return state.ended;
}

async function watch() {
    while (!await look())
        await new Promise((resolve) => setTimeout(resolve, 1000 * Number(live.dataset.every)));
}

watch();
