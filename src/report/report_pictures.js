// The pictures that the page holds (report/report_encode.h says how), and how they are shown.

const pictures = JSON.parse(document.getElementById("pictures").textContent);

// The float that each of the 65536 half floats stands for.
const FLOATS = Float32Array.from({length: 65536}, (_, bits) => {
    const sign = bits & 0x8000 ? -1 : 1, exponent = bits >> 10 & 31, rest = bits & 1023;
    if (exponent === 31) return rest ? NaN : sign * Infinity;
    if (exponent === 0) return sign * rest * 2 ** -24;
    return sign * (1024 + rest) * 2 ** (exponent - 25);
});

async function inflate(base64) {
    const packed = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
    const stream = new Blob([packed]).stream();
    const open = stream.pipeThrough(new DecompressionStream("deflate"));
    return new Uint8Array(await new Response(open).arrayBuffer());
}

// Numbers from what is left of them by subtracting the mean of the left and the upper one.
function restorePlane(bytes, plane, width, height) {
    const pixels = width * height, numbers = new Int16Array(pixels);
    const low = 2 * plane * pixels, high = low + pixels;
    for (let y = 0, i = 0; y < height; y++)
        for (let x = 0; x < width; x++, i++) {
            const z = bytes[low + i] | bytes[high + i] << 8;
            const left = x > 0 ? numbers[i - 1] : numbers[i - width];
            const upper = y > 0 ? numbers[i - width] : left;
            const guess = i === 0 ? 0 : x === 0 ? upper : left + upper >> 1;
            numbers[i] = guess + (z >> 1 ^ -(z & 1));
        }
    return numbers;
}

// Radiance, [height][width][3].
function restore(bytes, picture) {
    const {width, height, exponent, shift} = picture;
    const values = new Float32Array(3 * width * height);
    const [green, red, blue] =
        [0, 1, 2].map((plane) => restorePlane(bytes, plane, width, height));
    const unit = 2 ** exponent;
    for (let i = 0; i < width * height; i++) {
        values[3 * i] = unit * FLOATS[(red[i] + green[i]) << shift & 0xffff];
        values[3 * i + 1] = unit * FLOATS[green[i] << shift & 0xffff];
        values[3 * i + 2] = unit * FLOATS[(blue[i] + green[i]) << shift & 0xffff];
    }
    return values;
}

// Once for each picture that is looked at.
function valuesOf(index) {
    const picture = pictures[index];
    picture.values ??= inflate(document.getElementById(`picture-${index}`).textContent)
        .then((bytes) => restore(bytes, picture));
    return picture.values;
}

const luminance = (values, i) =>
    0.2126 * values[3 * i] + 0.7152 * values[3 * i + 1] + 0.0722 * values[3 * i + 2];

// --- to the screen -------------------------------------------------------------------

const SHOULDER = 0.6; // linear up to here, then bent towards 1

// IEC 61966-2-1; a NaN is black.
function srgb(linear) {
    const x = linear > 0 ? Math.min(linear, 1) : 0;
    return Math.floor(
        255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055) + 0.5);
}

// As image/preview.c shows pictures: hue and saturation stay where highlights are bent.
function toneMapped(values, scale) {
    const count = values.length / 3, bytes = new Uint8ClampedArray(4 * count);
    for (let i = 0; i < count; i++) {
        const r = scale * values[3 * i], g = scale * values[3 * i + 1];
        const b = scale * values[3 * i + 2], most = Math.max(r, g, b);
        let bend = 1;
        if (most > SHOULDER && most < Infinity) {
            const room = 1 - SHOULDER;
            bend = (SHOULDER + room * (1 - Math.exp((SHOULDER - most) / room))) / most;
        }
        bytes[4 * i] = srgb(bend * r);
        bytes[4 * i + 1] = srgb(bend * g);
        bytes[4 * i + 2] = srgb(bend * b);
        bytes[4 * i + 3] = 255;
    }
    return bytes;
}

// --- differences ---------------------------------------------------------------------

// Black, red, yellow, white, in equal steps of [0,1].
function heat(t, bytes, i) {
    bytes[4 * i] = 255 * Math.min(3 * t, 1);
    bytes[4 * i + 1] = 255 * Math.min(Math.max(3 * t - 1, 0), 1);
    bytes[4 * i + 2] = 255 * Math.min(Math.max(3 * t - 2, 0), 1);
}

// As image/metric.c shows them: red where the picture is too bright, blue where too dark.
function redAndBlue(t, bytes, i) {
    bytes[4 * i] = srgb(t);
    bytes[4 * i + 1] = 0;
    bytes[4 * i + 2] = srgb(-t);
}

function meanOf(count, value) {
    let sum = 0, finite = 0;
    for (let i = 0; i < count; i++) {
        const x = value(i);
        if (Number.isFinite(x)) {
            sum += x;
            finite++;
        }
    }
    return finite ? sum / finite : 0;
}

// What is shown of picture a against picture b, at pixel i; each has its unit.
const MEASURES = {
    signed(a, b) {
        const offset = 0.1 * Math.abs(meanOf(b.length / 3, (i) => luminance(b, i)));
        return (i) => {
            const d = luminance(a, i) - luminance(b, i);
            return d === 0 ? 0 : d / (Math.abs(luminance(b, i)) + offset);
        };
    },
    absolute(a, b) {
        const mean = Math.abs(meanOf(b.length / 3, (i) => luminance(b, i))) || 1;
        return (i) => Math.abs(luminance(a, i) - luminance(b, i)) / mean;
    },
    squared(a, b) {
        return (i) => {
            let sum = 0;
            for (let c = 3 * i; c < 3 * i + 3; c++)
                sum += (a[c] - b[c]) ** 2 / (b[c] ** 2 + 0.01);
            return sum / 3;
        };
    },
};

function difference(a, b, measure, range) {
    const count = a.length / 3, bytes = new Uint8ClampedArray(4 * count);
    const value = MEASURES[measure](a, b), paint = measure === "signed" ? redAndBlue : heat;
    for (let i = 0; i < count; i++) {
        const t = value(i) / range;
        bytes[4 * i + 3] = 255;
        if (Number.isNaN(t)) bytes[4 * i + 1] = 255;
        else paint(Math.min(Math.max(t, -1), 1), bytes, i);
    }
    return bytes;
}
