"""CPE aggregates beside spheres cut out of compressed cells: the same made collisions with known differences."""

import json

import pytest
from made_collisions import RADIUS, made_run

from analysis.__main__ import main


def compressed_run(path, seed, cut=None, **values):
    """A made collision of spheres that were cut with a radius of 20 r, `cut` r around the outermost centre."""
    made_run(path, 20.0 - cut, 10**0.5, seed, values.pop("shift"), **values, packing="file")
    record = json.loads((path / "run.json").read_text())
    about = {"packing": "compressed", "filling": 0.401, "nominal": 0.4, "cell": seed, "aggregateRadius": 20 * RADIUS}
    record["derived"].update(targetPacking=about, projectilePacking={**about, "filling": 0.399})
    (path / "run.json").write_text(json.dumps(record))


def test_compressed_less_stiff_than_cpe(tmp_path, capsys):
    """Made compressions that are 1.5 times as large; the sphere that was cut is larger than the one around the centres."""
    for seed in (1, 2, 3):
        made_run(tmp_path / f"cpe{seed}", 20.0, 10**0.5, seed, 0.1 * seed)
        compressed_run(tmp_path / f"cut{seed}", seed, cut=0.0, stretch=1.5, shift=0.1 * seed)
    assert main(["study", "compressed", str(tmp_path), "--json", "--figures", str(tmp_path / "out")]) == 0
    sections = json.loads(capsys.readouterr().out)["sections"]
    rows = {row["quantity"]: row for row in sections[0]["rows"]}
    d = rows["d_max"]
    assert d["cpe"][2] == d["compressed"][2] == 3 and d["p"] < 0.05
    assert d["compressed"][0] > d["cpe"][0] + 0.4
    assert d["cpe"][1] == pytest.approx(0.1 / 3**0.5, rel=1e-6)
    assert d["ratio"][0] == pytest.approx(d["compressed"][0] / d["cpe"][0])
    assert rows["t_max after the touch"]["ratio"][0] == pytest.approx(1.5, rel=0.05)
    assert rows["filling"]["cpe"][0] == rows["filling"]["compressed"][0] == pytest.approx(0.4)
    assert (tmp_path / "out" / "compression.png").exists()


def test_d_is_from_the_sphere_that_was_cut(tmp_path, capsys):
    compressed_run(tmp_path / "a", 1, cut=0.0, shift=0.0)
    compressed_run(tmp_path / "b", 2, cut=0.3, shift=0.0)
    assert main(["study", "compressed", str(tmp_path), "--json", "--figures", str(tmp_path / "out")]) == 0
    text = (tmp_path / "out" / "runs.csv").read_text()
    lines = [line.split(",") for line in text.splitlines() if not line.startswith("#")]
    place = lines[0].index("d_max")
    found = [float(line[place]) for line in lines[1:]]
    # made_run's aggregates have the radius of the sphere around their centres; d grows by twice the difference, less what
    # smaller spheres are compressed less.
    assert 0.5 < (found[1] - found[0]) / RADIUS < 0.6


def test_other_packings_from_files_are_left_out(tmp_path, capsys):
    made_run(tmp_path / "a", 20.0, 10**0.5, 1, 0.0)
    made_run(tmp_path / "b", 20.0, 10**0.5, 1, 0.0, packing="file")
    assert main(["study", "compressed", str(tmp_path), "--json"]) == 0
    assert "neither CPE aggregates nor spheres cut out of compressed cells, left out" in capsys.readouterr().err


def test_compression_is_measured_from_the_first_touch(tmp_path, capsys):
    """A zero of d that lies elsewhere in one kind changes d_max and its ratio, and the compression not at all."""
    for seed in (1, 2, 3):
        made_run(tmp_path / f"cpe{seed}", 20.0, 10**0.5, seed, 0.1 * seed)
        compressed_run(tmp_path / f"cut{seed}", seed, cut=0.0, shift=0.1 * seed - 0.3)
    assert main(["study", "compressed", str(tmp_path), "--json"]) == 0
    rows = {row["quantity"]: row for row in json.loads(capsys.readouterr().out)["sections"][0]["rows"]}
    own, touch, d = (rows[name] for name in ("compression from the first touch", "d at the first touch", "d_max"))
    assert own["ratio"][0] == pytest.approx(1.0, abs=1e-9) and own["cpe"][1] < 1e-9
    assert own["cpe"][0] == pytest.approx(d["cpe"][0] - touch["cpe"][0])
    assert touch["compressed"][0] == pytest.approx(touch["cpe"][0] - 0.3) and d["ratio"][0] < 0.9


@pytest.mark.parametrize(
    "changed, shown",
    [
        ({"surfaceEnergy": 0.05}, "ice (gamma = 0.05 J/m^2)"),
        ({"criticalRolling": 4e-10}, "ice (xi_crit = 4 Å)"),
        ({"timeStep": 0.2}, "ice"),
    ],
)
def test_private_grains_and_steps_are_kept_apart(tmp_path, capsys, changed, shown):
    """The same pairs of other grains are neither duplicates nor of the same means."""
    for seed in (1, 2):
        for kind in ("own", "other"):
            paths = [tmp_path / f"{kind}-cpe{seed}", tmp_path / f"{kind}-cut{seed}"]
            made_run(paths[0], 20.0, 10**0.5, seed, 0.1 * seed)
            compressed_run(paths[1], seed, cut=0.0, shift=0.1 * seed)
            for path in paths if kind == "other" else ():
                record = json.loads((path / "run.json").read_text())
                unit = record["derived"]["timeUnit"]
                record["derived"].update({name: v * unit if name == "timeStep" else v for name, v in changed.items()})
                (path / "run.json").write_text(json.dumps(record))
    assert main(["study", "compressed", str(tmp_path), "--json"]) == 0
    out, err = capsys.readouterr()
    rows = [row for row in json.loads(out)["sections"][0]["rows"] if row["quantity"] == "d_max"]
    assert "the same" not in err and [row["cpe"][2] for row in rows] == [2, 2]
    assert main(["study", "compressed", str(tmp_path)]) == 0
    assert shown in capsys.readouterr().out
