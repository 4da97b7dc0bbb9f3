"""test_report.py PAGE REFERENCE.png [SHOTS]: the page of `etalon report` as a reader has it.

PAGE shows one scene, "box", of eight cells. One line a check; status 1 if one failed. With
SHOTS, a folder, pictures of the page are left there."""

import base64
import os
import sys

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

PAGE, PNG = sys.argv[1], sys.argv[2]
SHOTS = sys.argv[3] if len(sys.argv) > 3 else ""
WIDTH, HEIGHT = 1280, 1000

failures = 0


def check(what, right, seen=""):
    global failures
    failures += not right
    print(f"{'ok  ' if right else 'FAIL'}  {what}{'' if right else f': {seen}'}")


def open_browser():
    options = Options()
    for argument in ("--headless=new", "--no-sandbox", "--hide-scrollbars",
                     f"--window-size={WIDTH},{HEIGHT}", "--force-device-scale-factor=1"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    browser = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
    browser.set_script_timeout(20)
    return browser


browser = open_browser()


def js(script, *arguments):
    return browser.execute_script(script, *arguments)


def prefer(scheme):
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {
        "features": [{"name": "prefers-color-scheme", "value": scheme}]})


def find(selector):
    return browser.find_element(By.CSS_SELECTOR, selector)


def settle():
    """Until the comparer has drawn what it was asked for."""
    browser.execute_async_script("""
        const done = arguments[0], comparer = document.querySelector(".comparer").comparer;
        Promise.resolve(comparer.waiting).then(() => comparer.drawing).then(done);""")


def pixels(which=0):
    settle()
    return js("""
        const canvas = document.querySelectorAll(".comparer canvas")[arguments[0]];
        const {width, height} = canvas;
        return [...canvas.getContext("2d").getImageData(0, 0, width, height).data];""", which)


def press(keys):
    browser.switch_to.active_element.send_keys(keys)
    settle()


def choose(select, part):
    """The option of A or B whose name contains `part`."""
    js("""
        const select = document.querySelector(`.comparer .${arguments[0]}`);
        select.value = [...select.options].find((o) => o.text.includes(arguments[1])).value;
        select.dispatchEvent(new Event("change"));""", select, part)
    settle()


def luminance(colour):
    """Relative luminance of an sRGB colour (WCAG)."""
    linear = [c / 255 / 12.92 if c <= 10 else ((c / 255 + 0.055) / 1.055) ** 2.4
              for c in colour]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(a, b):
    low, high = sorted((luminance(a), luminance(b)))
    return (high + 0.05) / (low + 0.05)


def shot(name):
    if not SHOTS:
        return
    os.makedirs(SHOTS, exist_ok=True)
    size = js("return [document.documentElement.clientWidth,"
              " document.documentElement.scrollHeight]")
    answer = browser.execute_cdp_cmd("Page.captureScreenshot", {
        "captureBeyondViewport": True,
        "clip": {"x": 0, "y": 0, "width": size[0], "height": size[1], "scale": 1}})
    with open(f"{SHOTS}/{name}.png", "wb") as file:
        file.write(base64.b64decode(answer["data"]))


# --- the page ----------------------------------------------------------------------------

def test_structure():
    check("the title", browser.title == "page · Etalon", browser.title)
    check("names are text, not tags", js("return document.querySelectorAll('b b, td b')"
                                         ".length") == 0)
    labels = js("return [...document.querySelectorAll('#errors-0 .method')]"
                ".map((cell) => cell.firstChild.data.trim())")
    check("a row a cell", len(labels) == 8, labels)
    check("names in full", any('<b>paper</b> & "co" </script>' in label for label in labels),
          labels)
    check("biased cells say so", js("return document.querySelectorAll('#errors-0 .biased')"
                                    ".length") == 4)
    check("nothing sticks out", js("return document.documentElement.scrollWidth <= "
                                   "innerWidth"))
    check("every control has a name", js("""
        const name = (e) => e.getAttribute("aria-label") || e.textContent.trim() ||
            e.labels && [...e.labels].map((l) => l.textContent.trim()).join("");
        return [...document.querySelectorAll("button, select, input")]
            .filter((e) => !name(e)).map((e) => e.outerHTML)""") == [])
    ids = js("return [...document.querySelectorAll('[id]')].map((e) => e.id)")
    check("no id twice", len(ids) == len(set(ids)))


def column(table, index):
    return js("""
        return [...document.querySelectorAll(`#${arguments[0]} tbody tr`)]
            .map((row) => row.cells[arguments[1]].dataset.value ?? null)""", table, index)


def test_sorting():
    button = find("#errors-0 th button[data-column='2']")
    before = column("errors-0", 2)
    head = button.find_element(By.XPATH, "..")
    check("unsorted", head.get_attribute("aria-sort") == "none")
    button.click()
    values = [float(x) for x in column("errors-0", 2)]
    check("sorted by value", values == sorted(values), values)
    check("it was another order", [float(x) for x in before] != values, before)
    check("and says so", head.get_attribute("aria-sort") == "ascending")
    # By keyboard, and by value, not by text: 1e-5 is less than 0.002.
    js("""
        const cell = document.querySelector("#errors-0 tbody tr:last-child td:nth-child(3)");
        cell.dataset.value = "1e-5";""")
    button.send_keys(Keys.ENTER)
    values = [float(x) for x in column("errors-0", 2)]
    check("descending by the keyboard", values == sorted(values, reverse=True), values)
    check("small last", values[-1] == 1e-5, values)
    check("descending says so", head.get_attribute("aria-sort") == "descending")
    find("#errors-0 th button[data-column='0']").send_keys(Keys.SPACE)
    names = js("return [...document.querySelectorAll('#errors-0 .method')]"
               ".map((cell) => cell.textContent)")
    check("texts by the alphabet, numbers in them by value",
          names.index("pssmlt p_l=0.02") < names.index("pssmlt p_l=0.1"), names)
    check("the other column no more", head.get_attribute("aria-sort") == "none")


def test_filter():
    js("document.querySelectorAll('input.filter').forEach((e) => {"
       " e.closest('details')?.setAttribute('open', '') })")
    box = find("input.filter[data-table='drift-0']")
    rows = len(js("return [...document.querySelectorAll('#drift-0 tbody tr')]"
                  ".filter((row) => !row.hidden)"))
    box.send_keys("pssmlt eta_l")
    shown = js("return [...document.querySelectorAll('#drift-0 tbody tr')]"
               ".filter((row) => !row.hidden).map((row) => row.textContent)")
    check("the filter hides rows", 0 < len(shown) < rows, (len(shown), rows))
    check("of other words", all("pssmlt" in row and "eta_l" in row for row in shown), shown)
    box.clear()


def test_plots():
    count = js("return document.querySelectorAll('.panel svg').length")
    if count == 0:
        print("          no plots: no gnuplot")
        return
    check("plots", count >= 6, count)
    check("plots have size", js("""
        return [...document.querySelectorAll(".panel svg")]
            .every((svg) => svg.getBBox().width > 200 && svg.clientHeight > 100)"""))
    check("marks are there", js("""
        return [...document.querySelectorAll(".panel svg use[transform]")].length > 20 &&
            [...document.querySelectorAll(".panel svg use")].every(
            (use) => document.getElementById(use.getAttribute("xlink:href").slice(1)))"""))
    entry = find(".legend [data-series]")
    js("arguments[0].focus()", entry)
    check("a legend's entry singles out its line",
          js("return document.querySelectorAll('.singled g.single').length") >= 1)
    js("document.activeElement.blur()")
    check("and lets go", js("return document.querySelectorAll('.singled').length") == 0)


def colour_of(selector, what):
    text = js("""
        const canvas = document.createElement("canvas")
            .getContext("2d", {willReadFrequently: true});
        canvas.fillStyle = getComputedStyle(document.querySelector(arguments[0]))[arguments[1]];
        canvas.fillRect(0, 0, 1, 1);
        return [...canvas.getImageData(0, 0, 1, 1).data]""", selector, what)
    return text[:3]


def check_contrast(name):
    page = colour_of("body", "backgroundColor")
    for what, selector, least in (("text", "body", 7), ("captions", "caption", 4.5),
                                  ("biased", "td .biased", 4.5)):
        seen = contrast(colour_of(selector, "color"), page)
        check(f"{name}: contrast of {what}", seen >= least, f"{seen:.2f}")
    lines = js("""
        const style = getComputedStyle(document.documentElement);
        const canvas = document.createElement("canvas")
            .getContext("2d", {willReadFrequently: true});
        const probe = document.body.appendChild(document.createElement("i"));
        const numbers = [1, 3, 4, 10, 11, 12, 13, 14, 15, 16, 17, 20, 21, 22, 23, 24, 25, 26,
            27, 28, 29];
        const colours = numbers.map((n) => {
            probe.style.color = `var(--plot-${n})`;
            canvas.fillStyle = getComputedStyle(probe).color;
            canvas.fillRect(0, 0, 1, 1);
            return [n, ...canvas.getImageData(0, 0, 1, 1).data];
        });
        probe.remove();
        return colours""")
    for number, *colour in lines:
        seen = contrast(colour[:3], page)
        check(f"{name}: contrast of plot colour {number}", seen >= 3, f"{seen:.2f}")
    return page


def test_themes():
    prefer("light")
    light = check_contrast("light")
    shot("light")
    prefer("dark")
    dark = check_contrast("dark")
    shot("dark")
    check("light is lighter", luminance(light) > 0.8 and luminance(dark) < 0.05)
    button = find("#theme")
    button.send_keys(Keys.ENTER)
    check("the button makes it light", colour_of("body", "backgroundColor") == light)
    browser.refresh()
    check("and it is kept", colour_of("body", "backgroundColor") == light)
    find("#theme").send_keys(Keys.ENTER)
    prefer("light")
    check("or dark", colour_of("body", "backgroundColor") == dark)
    find("#theme").send_keys(Keys.ENTER)
    check("or as the system has it", colour_of("body", "backgroundColor") == light)


# --- pictures ----------------------------------------------------------------------------

def test_tone_mapping():
    with open(PNG, "rb") as file:
        png = base64.b64encode(file.read()).decode()
    expected = browser.execute_async_script("""
        const [png, done] = arguments, image = new Image();
        image.onload = () => {
            const canvas = document.createElement("canvas");
            canvas.width = image.width;
            canvas.height = image.height;
            const context = canvas.getContext("2d", {willReadFrequently: true});
            context.drawImage(image, 0, 0);
            done([...context.getImageData(0, 0, image.width, image.height).data]);
        };
        image.src = "data:image/png;base64," + png;""", png)
    choose("a", "reference")
    seen = pixels()
    check("as many pixels as the preview has", len(seen) == len(expected))
    worst = max(abs(a - b) for a, b in zip(seen, expected))
    check("tone mapped as the preview is", worst <= 1, worst)


def linear(byte):
    x = byte / 255
    return x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4


def test_flip():
    choose("a", "pssmlt p_l=auto")
    choose("b", "reference")
    stage = find(".comparer .stage")
    js("arguments[0].focus()", stage)
    a = pixels()
    press(" ")
    b = pixels()
    check("flip shows another picture", a != b)
    check("and says which", find(".comparer figcaption").text.startswith("B: reference"))
    press("f")
    check("flip back", pixels() == a)
    press("x")
    check("exchanged", pixels() == b)
    press("x")


def test_exposure():
    before = pixels()
    for _ in range(4):
        press("+")
    after = pixels()
    check("the exposure is told", find(".comparer .ev").text == "+1.00 EV")
    # Twice as bright, where neither is bent (all channels below .6) nor black.
    ratios = []
    for i in range(0, len(before), 4):
        x, y = before[i:i + 3], after[i:i + 3]
        if max(linear(c) for c in y) < 0.58:
            ratios += [linear(v) / linear(u) for u, v in zip(x, y) if u > 60]
    middle = sorted(ratios)[len(ratios) // 2]
    check("a stop is twice as bright", len(ratios) > 20 and abs(middle - 2) < 0.02 and
          all(abs(r - 2) < 0.1 for r in ratios), (len(ratios), middle))
    press("0")
    check("the exposure back to 0", pixels() == before)


def test_slider():
    a = pixels()
    press(" ")
    b = pixels()
    press(" ")
    press("3")
    wipe = find(".comparer .wipe")
    check("the slider is there", wipe.is_displayed())
    js("arguments[0].focus()", wipe)
    browser.switch_to.active_element.send_keys(Keys.HOME)
    check("all B", pixels() == b)
    browser.switch_to.active_element.send_keys(Keys.END)
    check("all A", pixels() == a)
    js("arguments[0].value = 50; arguments[0].dispatchEvent(new Event('input'))", wipe)
    seen, width = pixels(), 32
    rows = range(0, len(seen), 4 * width)
    half = 4 * width // 2
    check("A to the left, B to the right",
          all(seen[r:r + half] == a[r:r + half] and
              seen[r + half:r + 4 * width] == b[r + half:r + 4 * width] for r in rows))
    before = pixels()
    canvas = find(".comparer canvas")
    webdriver.ActionChains(browser).move_to_element_with_offset(
        canvas, -canvas.size["width"] // 4, 0).click_and_hold().release().perform()
    check("the pointer moves the edge", pixels() != before)
    js("document.querySelector('.comparer .stage').focus()")


def test_side():
    press("2")
    check("two pictures", find(".comparer figure:nth-of-type(2)").is_displayed())
    check("side by side", pixels(0) != pixels(1))
    shot("side-by-side")


def test_difference():
    press("4")
    seen = pixels(0)
    reds = sum(seen[i] > 30 for i in range(0, len(seen), 4))
    blues = sum(seen[i + 2] > 30 for i in range(0, len(seen), 4))
    check("too bright red, too dark blue", reds > 50 and blues > 50, (reds, blues))
    check("never both", all(not (seen[i] and seen[i + 2]) and not seen[i + 1]
                            for i in range(0, len(seen), 4)))
    check("B, the reference itself, is not shown",
          not find(".comparer figure:nth-of-type(2)").is_displayed())
    choose("a", "reference")
    check("the reference differs nowhere from itself",
          all(v == 0 or i % 4 == 3 for i, v in enumerate(pixels(0))))
    choose("a", "pssmlt p_l=auto")
    choose("b", "p_l=0.02")
    check("two differences", any(v and i % 4 != 3 for i, v in enumerate(pixels(1))))
    js("""const range = document.querySelector(".comparer .range");
          range.value = 4; range.dispatchEvent(new Event("input"));""")
    settle()
    check("a wide range is darker", sum(pixels(0)) < sum(seen))
    for measure in ("absolute", "squared"):
        js("""const select = document.querySelector(".comparer .measure");
              select.value = arguments[0]; select.dispatchEvent(new Event("change"));
              const range = document.querySelector(".comparer .range");
              range.value = -1; range.dispatchEvent(new Event("input"));""", measure)
        heat = pixels(0)
        check(f"{measure}: another picture", heat != seen and any(heat[0::4]))
    shot("difference")


def test_biased():
    """In every view the caption says so."""
    choose("a", "(biased)")
    for view in "1234":
        press(view)
        captions = js("return [...document.querySelectorAll('.comparer figcaption')]"
                      ".map((c) => c.textContent)")
        check(f"view {view} says biased", "biased" in captions[0], captions)
    choose("a", "pssmlt p_l=auto")


def test_readout():
    press("1")
    press(Keys.ESCAPE)
    press(Keys.ARROW_RIGHT)
    settle()
    first = find(".comparer .readout").text
    check("arrows read a pixel", "pixel 17, 12" in first and "reference" in first, first)
    press(Keys.SHIFT + Keys.ARROW_UP)
    check("by ten", "pixel 17, 2" in find(".comparer .readout").text,
          find(".comparer .readout").text)
    press(Keys.NULL + "z")
    check("zoom", find(".comparer .zoom").get_attribute("value") == "1")
    check("of pixels", js("return getComputedStyle(document.querySelector("
                          "'.comparer canvas')).imageRendering") == "pixelated")
    check("one to one", js("return document.querySelector('.comparer canvas').clientWidth")
          == 32)
    press("Z")
    canvas = find(".comparer canvas")
    webdriver.ActionChains(browser).move_to_element(canvas).move_by_offset(2, 2).perform()
    settle()
    check("so does the pointer", "pixel 1" in find(".comparer .readout").text,
          find(".comparer .readout").text)
    press(Keys.ESCAPE)
    check("esc ends reading", find(".comparer .readout").text == "")


def test_keyboard_only():
    """From the top of the page by tab alone: everything comes by, and is seen to."""
    js("document.activeElement.blur(); scrollTo(0, 0)")
    reached, unseen = set(), []
    for _ in range(250):
        webdriver.ActionChains(browser).send_keys(Keys.TAB).perform()
        where = js("""
            const e = document.activeElement, style = getComputedStyle(e);
            const shown = e.matches(".views input") ? getComputedStyle(e.nextElementSibling)
                : style;
            return [e.id || e.className || e.tagName, shown.outlineStyle]""")
        if where[0] == "BODY":
            break
        reached.add(where[0])
        if where[1] == "none":
            unseen.append(where[0])
    for name in ("theme", "a", "swap", "b", "exposure", "reset", "zoom", "stage"):
        check(f"tab comes to {name}", name in reached, reached)
    check("focus is seen", not unseen, unseen)


def test_narrow():
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
        "width": 420, "height": 900, "deviceScaleFactor": 1, "mobile": False})
    js("scrollTo(0, 0)")
    settle()
    check("a narrow window scrolls down only",
          js("return document.documentElement.scrollWidth <= innerWidth"),
          js("return [...document.querySelectorAll('body *')].filter((e) => "
             "!e.closest('.table') && e.getBoundingClientRect().right > innerWidth)"
             ".map((e) => e.tagName + '.' + e.className)"))
    shot("narrow")
    browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


def test_quiet():
    log = browser.get_log("browser")
    check("no errors or warnings", log == [], log)
    asked = [entry["message"] for entry in browser.get_log("performance")
             if '"Network.requestWillBeSent"' in entry["message"]]
    away = [m for m in asked if '"url":"http' in m or '"url":"ws' in m]
    check("nothing from outside", not away, away)


def main():
    prefer("light")
    browser.get(f"file://{PAGE}")
    js("document.querySelector('.comparer').scrollIntoView()")
    browser.execute_async_script("""
        const done = arguments[0], wait = () =>
            document.querySelector(".comparer").dataset.drawn ? done() : setTimeout(wait, 20);
        wait();""")
    for test in (test_structure, test_sorting, test_filter, test_plots, test_themes,
                 test_tone_mapping, test_flip, test_exposure, test_slider, test_side,
                 test_difference, test_biased, test_readout, test_keyboard_only, test_narrow, test_quiet):
        test()


try:
    main()
finally:
    browser.quit()
sys.exit(failures > 0)
