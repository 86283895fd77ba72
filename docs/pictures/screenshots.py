#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Takes the pictures in pixels: the report of examples/slider_crank and examples/path_line in Chromium without a window, and the README's of
the tuned slider-crank (a minute of one core): screenshots.py FETTLE [FOLDER], from the root of the repository. Needs chromium, fonts-inter,
the font that the report asks for first, and python3-numpy."""
import base64
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(ROOT / "tests/design/report"))
from chromium import Chromium  # noqa: E402

# Where each stands, from the root of the repository.
PICTURES = {name: f"docs/pictures/{name}.png" for name in ("report", "report_gap", "report_search", "report_dark", "report_phone", "report_starts")}
PICTURES["slider_crank"] = "examples/slider_crank/slider_crank.png"


def to_section(title):
    """JavaScript that scrolls to a section, and leaves some room above it."""
    return f"""(() => {{ const h = [...document.querySelectorAll("h2")].find((e) => e.textContent === {title!r});
        scrollTo({{top: h.getBoundingClientRect().top + scrollY - 24, behavior: "instant"}}); }})()"""


def to_stage(page):
    page.value("scrollTo({top: document.querySelector('.stage').getBoundingClientRect().top + scrollY - 16, behavior: 'instant'})")


def show_gap(page):
    page.click("tr[data-pair='0'] button")
    page.wait("!window.fettleReport.motion.viewer.flight")
    to_stage(page)


def show_both(page):
    page.value("window.fettleReport.motion.seek(0.4)")
    page.click("#compare input[value=fade]")
    page.click("#section")
    page.value("(() => { const e = document.querySelector('#section-axis'); e.value = 'z'; e.dispatchEvent(new Event('change', {bubbles: true})); })()")
    page.wait("!window.fettleReport.motion.viewer.flight")
    page.value("scrollTo({top: document.querySelector('.stage').getBoundingClientRect().top + scrollY - 112, behavior: 'instant'})")


# Name: folder of results, size, dark, what is done before.
SHOTS = {
    "report": ("slider_crank", (1280, 1010), False, lambda page: None),
    "report_gap": ("slider_crank", (1280, 800), False, show_gap),
    "report_search": ("slider_crank", (1280, 1000), False, lambda page: page.value(to_section("What limits the design"))),
    "report_dark": ("slider_crank", (1440, 900), True, show_both),
    "report_phone": ("slider_crank", (390, 844), False, lambda page: None),
    "report_starts": ("path_line", (1280, 560), False, lambda page: page.value(to_section("Starts"))),
}


def with_palette(page, png):
    """The picture with its 256 most frequent colours, the others as the nearest of them: a third of the bytes. The browser decodes it."""
    import numpy as np  # here, so that what pictures there are can be asked without it

    width, height, text = page.value(f"""(async () => {{
        const image = new Image(); image.src = "data:image/png;base64,{base64.b64encode(png).decode()}"; await image.decode();
        const canvas = document.createElement("canvas"); canvas.width = image.width; canvas.height = image.height;
        const context = canvas.getContext("2d"); context.drawImage(image, 0, 0);
        const data = context.getImageData(0, 0, image.width, image.height).data; let text = "";
        for (let i = 0; i < data.length; i += 8192) text += String.fromCharCode(...data.subarray(i, i + 8192));
        return [image.width, image.height, btoa(text)]; }})()""")
    pixels = np.frombuffer(base64.b64decode(text), np.uint8).reshape(-1, 4)[:, :3].astype(int)
    colours, which, counts = np.unique(pixels @ [65536, 256, 1], return_inverse=True, return_counts=True)
    channels = np.stack([colours >> 16, colours >> 8 & 255, colours & 255], axis=1)
    palette = channels[np.sort(np.argsort(-counts, kind="stable")[:256])]
    nearest = np.array([np.argmin(((palette - each) ** 2).sum(axis=1)) for each in channels], np.uint8)
    rows = nearest[which].reshape(height, width)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    lines = zlib.compress(b"".join(b"\0" + row.tobytes() for row in rows), 9)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0)) +
            chunk(b"PLTE", palette.astype(np.uint8).tobytes()) + chunk(b"IDAT", lines) + chunk(b"IEND", b""))


def take(browser, file, size, dark, prepare):
    page = browser.open(file.resolve().as_uri(), width=size[0], height=size[1], dark=dark, still=True)
    page.wait("window.fettleReport?.motion?.viewer.drawn > 0")
    prepare(page)
    page.value("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
    shot = page.send("Page.captureScreenshot", format="png", optimizeForSpeed=False)
    if page.complaints:
        raise RuntimeError(f"{file}: {page.complaints}")
    page.close()
    return base64.b64decode(shot["data"])


def what_is_missing():
    """Why no pictures can be taken that look the same on every machine; empty: they can."""
    if shutil.which("chromium") is None and shutil.which("chromium-browser") is None:
        return "Chromium is not installed (apt-get install chromium)"
    matched = shutil.which("fc-match") and subprocess.run(["fc-match", "--format=%{family}", "Inter"], capture_output=True, text=True, check=False)
    if not matched or not matched.stdout.startswith("Inter"):
        return "the font Inter is not installed (apt-get install fonts-inter fontconfig)"
    if subprocess.run(["/usr/bin/python3", "-c", "import numpy"], capture_output=True, check=False).returncode:
        return "/usr/bin/python3 has no numpy (apt-get install python3-numpy)"
    return ""


def main(program, folder=None):
    if missing := what_is_missing():
        sys.exit(missing)
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    places = {name: pathlib.Path(folder) / pathlib.Path(path).name if folder else ROOT / path for name, path in PICTURES.items()}
    with tempfile.TemporaryDirectory() as temporary:
        out = pathlib.Path(temporary)
        for name, more in (("slider_crank", []), ("path_line", ["--starts", "6"])):
            design = f"examples/{name}/{name}.design.json"
            subprocess.run([program, "optimise", design, *more, "--out", str(out / name), "--quiet"], cwd=ROOT, stdout=subprocess.DEVNULL, check=False)
        browser = Chromium(chromium)
        try:
            for name, (run, size, dark, prepare) in SHOTS.items():
                png = take(browser, out / run / "report.html", size, dark, prepare)
                blank = browser.open("about:blank")
                places[name].write_bytes(with_palette(blank, png))
                blank.close()
                print(f"{name}.png: {places[name].stat().st_size} bytes")
        finally:
            browser.close()
        subprocess.run(["/usr/bin/python3", str(ROOT / "examples/slider_crank/draw.py"), str(out / "slider_crank/trajectory.json"),
                        str(places["slider_crank"]), "35"], check=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
