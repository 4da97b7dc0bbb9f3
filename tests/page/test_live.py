"""test_live.py URL PID [SHOTS]: the page of a run that is going on as a reader has it.

PID is the run's, which is ended here with SIGINT after a while; 0: it has ended. One line a
check; status 1 if one failed. With SHOTS, a folder, pictures of the page are left there."""

import base64
import os
import signal
import sys
import time

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service

URL, PID = sys.argv[1], int(sys.argv[2])
SHOTS = sys.argv[3] if len(sys.argv) > 3 else ""
KIND = URL.split(":")[0]

failures = 0


def check(what, right, seen=""):
    global failures
    failures += not right
    print(f"{'ok  ' if right else 'FAIL'}  {KIND}: {what}{'' if right else f': {seen}'}")


def open_browser():
    options = Options()
    for argument in ("--headless=new", "--no-sandbox", "--hide-scrollbars",
                     "--window-size=1280,1000", "--force-device-scale-factor=1"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)


browser = open_browser()


def js(script):
    return browser.execute_script(script)


def wait(condition, seconds=60):
    """Until the script gives something true; what it last gave."""
    end = time.monotonic() + seconds
    while not (value := js(condition)) and time.monotonic() < end:
        time.sleep(0.1)
    return value


def shot(name):
    if not SHOTS:
        return
    os.makedirs(SHOTS, exist_ok=True)
    width, height = js("return [document.documentElement.clientWidth,"
                       " document.documentElement.scrollHeight]")
    answer = browser.execute_cdp_cmd("Page.captureScreenshot", {
        "captureBeyondViewport": True,
        "clip": {"x": 0, "y": 0, "width": width, "height": height, "scale": 1}})
    with open(f"{SHOTS}/{name}.png", "wb") as file:
        file.write(base64.b64decode(answer["data"]))


def pixels():
    return js("""
        const canvas = document.querySelector(".comparer canvas");
        if (!canvas || !canvas.width) return null;
        const {width, height} = canvas;
        return [width, height,
            ...canvas.getContext("2d").getImageData(0, 0, width, height).data];""")


TEXT = "document.getElementById('%s').textContent"

browser.get(URL)
wait("return Number(document.getElementById('live').dataset.shown) > 0")
wait("return document.querySelector('.comparer')?.dataset.drawn")
first = pixels()
check("a picture of the run's size", first and first[:2] == [64, 48], first and first[:2])
check("that is not black", first and max(first[2::4]) > 100)
check("how far it is", "mutations per pixel" in js("return " + TEXT % "status"))
check("statistics", wait("return document.querySelectorAll('#statistics tr').length") > 50)
check("in words", "pssmlt" in js("return " + TEXT % "summary"))
if PID:
    shot("live-early")
    look = js("return document.getElementById('live').dataset.shown")
    js("document.querySelector('.comparer .exposure').value = 1")
    newer = wait(f"return Number(document.getElementById('live').dataset.shown) > {look}")
    check("a newer picture comes by itself", newer)
    time.sleep(1)
    check("and is another", pixels() != first)
    check("settings stay", js("return document.querySelector('.comparer .exposure').value") == "1")
    os.kill(PID, signal.SIGINT)
ended = wait("return state.ended", 30)
check("the end", ended and "Ended" in js("return " + TEXT % "status"),
      js("return " + TEXT % "status"))
check("the verdict", "parts of the run" in js("return " + TEXT % "verdict"),
      js("return " + TEXT % "verdict"))
check("error bars beside the picture", wait("return 2 in pictures"))
check("error against time", wait("return document.querySelectorAll('#plot svg').length") == 1)
check("a legend of what is drawn", js("return document.querySelectorAll('#plot .legend li')"
                                      ".length") == (3 if PID else 2))
check("nothing sticks out", js("return document.documentElement.scrollWidth <= innerWidth"))
ids = js("return [...document.querySelectorAll('[id]')].map((e) => e.id)")
check("no id twice", len(ids) == len(set(ids)))
time.sleep(1)
shot(f"live-{KIND}")
errors = [line for line in browser.get_log("browser") if "ERR_CONNECTION" not in line["message"]]
check("no complaint of the browser", not errors, errors)
browser.quit()
sys.exit(failures > 0)
