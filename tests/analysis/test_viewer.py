"""The page on which aggregates are turned, as a real browser shows it."""

import base64
import io
import json
import re
import shutil

import numpy as np
import pytest
from PIL import Image
from written_runs import RADIUS, losing, record, state_arrays, two_clusters, write_run

from analysis.__main__ import main
from analysis.export.viewer import THREE
from analysis.runs.folder import open_alone, open_run

pytestmark = pytest.mark.skipif(not THREE.exists(), reason="libjs-three is not installed")
webdriver = pytest.importorskip("selenium.webdriver") if shutil.which("chromedriver") else None
in_browser = pytest.mark.skipif(webdriver is None, reason="chromium is not installed (make test-viewer installs it)")


def test_the_page_holds_the_states_and_reaches_for_nothing(tmp_path):
    run = two_clusters(tmp_path / "</script><b>x")
    assert main(["view", str(run)]) == 0
    page = (run / "view.html").read_text()
    data = json.loads(re.search(r'id="data">(.*?)</script>', page, re.S)[1])
    states = open_run(run).states
    middle = (states[0].position.min(axis=0) + states[0].position.max(axis=0)) / 2
    for packed, state in zip(data["states"], states, strict=True):
        position = np.frombuffer(base64.b64decode(packed["position"]), dtype="<f4").reshape(-1, 3)
        assert np.allclose(position * RADIUS + middle, state.position, atol=1e-5 * RADIUS)
    assert not re.search(r'<(script|link|img)[^>]*(src|href)="', page) and "<b>x" not in page


def test_a_packing_and_a_state_alone_are_shown(tmp_path):
    """By material where there are several; a state has the names of its run, a packing its own."""
    pairs, x = [(0, 1)], np.array([[0, 0, 0], [1.99, 0, 0], [5, 0, 0]]) * RADIUS
    of_grains = {"material": np.array([0, 1, 1]), "mass": np.array([1.0, 2, 2])}
    about = {**record(1e-6), "parameters": {"material": "ice,sand"}}
    run = write_run(
        tmp_path / "run", about, losing(np.ones(1)), [{**state_arrays(0, x, 0 * x, [0, 0, 0], pairs), **of_grains}]
    )
    materials = [{"name": name, "density": density} for name, density in (("ice", 1e3), ("sand", 2e3))]
    packing = tmp_path / "a.npz"
    text = json.dumps({"materials": materials})
    np.savez(packing, position=x, radius=np.full(3, RADIUS), material=of_grains["material"], seed=1, parameters=text)
    for file in (run / "states/000000.npz", packing):
        assert main(["view", str(file)]) == 0
        page = (file.parent / f"{file.stem}-view.html").read_text()
        data = json.loads(re.search(r'id="data">(.*?)</script>', page, re.S)[1])
        assert 'value="material" selected' in page
        assert [entry["text"] for entry in data["legends"]["material"]] == ["ice", "sand"]
        assert np.frombuffer(base64.b64decode(data["states"][0]["first"]), dtype="<u4").tolist() == [0]
    assert open_alone(packing).start.mass == pytest.approx(4 / 3 * np.pi * RADIUS**3 * np.array([1e3, 2e3, 2e3]))
    assert main(["view", str(run / "history.npz")]) == 2


@pytest.fixture
def browser():
    options = webdriver.ChromeOptions()
    software = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
    for option in ["--headless=new", "--no-sandbox", "--window-size=800,600", *software]:
        options.add_argument(option)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    with webdriver.Chrome(options=options) as driver:
        yield driver


def _shown(driver, number):
    """The picture (H, W, 3) once the state of this number is drawn."""
    from selenium.webdriver.support.ui import WebDriverWait

    WebDriverWait(driver, 20).until(lambda d: d.execute_script("return document.body.dataset.drawn") == str(number))
    return np.asarray(Image.open(io.BytesIO(driver.get_screenshot_as_png())).convert("RGB")).astype(float) / 255


@in_browser
def test_a_browser_draws_turns_and_goes_through_the_states(tmp_path, browser):
    run = two_clusters(tmp_path / "run")
    assert main(["view", str(run)]) == 0
    browser.get((run / "view.html").as_uri())
    first = _shown(browser, 0)
    browser.execute_script("let s = document.getElementById('slider'); s.value = 11; s.oninput();")
    last = _shown(browser, 11)
    assert abs(last - first).mean() > 1e-3 and "ns" in browser.find_element("id", "time").text
    choose = "let c = document.getElementById('colour'); c.value = arguments[0]; c.onchange();"
    for way in ("contacts", "speed", "fragment", "bond"):
        browser.execute_script(choose, way)
        assert browser.find_element("id", "legend").text
        assert abs(_shown(browser, 11) - last).mean() > 1e-3, way
    browser.find_element("id", "contacts").click()
    assert abs(_shown(browser, 11) - last).mean() > 1e-3
    assert [entry for entry in browser.get_log("browser") if entry["level"] == "SEVERE"] == []
