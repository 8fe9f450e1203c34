"""The measured errors of pictures agree with an independent measurement."""

from __future__ import annotations

from functools import cache
from math import inf, isfinite, isnan

import numpy as np
import pytest

import minirt
from minirt.cli.arguments import argument_parser
from minirt.errors import RenderError
from minirt.rendering.packing import lights
from minirt.report.crops import Crops
from minirt.report.pictures import FEW, LEFT_OUT, ONE_RUN, ReferencePicture, Row, SettingRenderer, reference
from minirt.report.settings import AUTO, KNOBS, Drawn, Knob, Setting, settings
from minirt.scene import FurtherLight, Scene
from tests.kernel.pictures import ALL, AMBIENT, EYE, LAMP, SHAPES
from tests.simulated_clock import PACKET_SECONDS, PROCESSOR_SHARE, Clock, packets, simulate_clock

WIDTH, HEIGHT, SAMPLES = 96, 64, 1024
WHOLE = Crops(HEIGHT, WIDTH)
ONCE = packets(WIDTH, HEIGHT) * PACKET_SECONDS  # seconds of the simulated clock that one sample in each pixel takes


@pytest.fixture(autouse=True)
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    """Simulate a clock that only rendering moves on."""
    return simulate_clock(monkeypatch)


@cache
def right() -> ReferencePicture:
    return reference(ALL, WHOLE, SAMPLES, seed=3)


def light(samples: int) -> np.ndarray:
    """Render a picture with the program."""
    made = minirt.render(ALL, WIDTH, HEIGHT, samples=samples).linear
    assert made is not None
    return np.clip(made, 0, 1)


def error(a: np.ndarray, b: np.ndarray) -> float:
    return float(np.linalg.norm(a - b) / np.sqrt(a.size))


def rows_for(
    *wanted: Setting, longest: float = inf, scene: Scene = ALL, near: ReferencePicture | None = None
) -> list[Row]:
    """Rows with wall times."""
    stage = SettingRenderer(scene, WIDTH, HEIGHT, 1, longest)
    rows = [stage.measured(setting, near or right())[0] for setting in wanted]
    stage.take_times(0.0)
    stage.stop()
    return [row.with_times(stage.times[row.name], 1, False) if row.name in stage.times else row for row in rows]


@cache
def rows() -> dict[tuple[str, float], Row]:
    return {(row.knob, float(row.label)): row for row in rows_for(*settings(ALL, 16, 0.005))}


@pytest.mark.parametrize("samples", [1, 4, 16])
def test_the_error_is_that_of_an_independent_measurement(samples: int) -> None:
    assert rows()["uniform", samples].rmse == pytest.approx(error(light(samples), light(1024)), rel=0.1)


def test_the_error_of_the_reference_is_what_it_says() -> None:
    finer = light(16384)
    assert right().error == pytest.approx(error(right().picture, finer), rel=0.5)
    assert right().error < rows()["uniform", 16].rmse / 5


def test_the_reference_follows_from_its_seed_and_has_other_places_than_the_pictures() -> None:
    few = reference(ALL, Crops(16, 32), 8, seed=3).picture
    assert np.array_equal(few, reference(ALL, Crops(16, 32), 8, seed=3).picture)
    assert not np.array_equal(few, reference(ALL, Crops(16, 32), 8, seed=4).picture)
    plain = minirt.render(ALL, 32, 16, samples=8).linear
    assert plain is not None
    assert not np.array_equal(few, np.clip(plain, 0, 1))


def test_more_samples_are_closer_and_take_longer() -> None:
    one, four, sixteen = (rows()["uniform", samples] for samples in (1, 4, 16))
    assert one.rmse > four.rmse > sixteen.rmse
    assert one.psnr < four.psnr < sixteen.psnr
    assert one.flip > four.flip > sixteen.flip > 0
    for row in (one, four, sixteen):
        assert row.ms == row.wall_ms == pytest.approx(row.samples * ONCE * 1e3)
        assert row.cpu_ms == pytest.approx(row.samples * ONCE * 1e3 * PROCESSOR_SHARE)
        assert row.rmse_low < row.rmse < row.rmse_high < 1.5 * row.rmse
        assert row.error_median < row.rmse < row.error_95 < row.error_largest
        assert row.ms_low <= row.ms <= row.ms_high
        assert row.efficiency == pytest.approx(1e3 / row.rmse**2 / row.ms)
        assert row.runs == FEW


def test_knobs_do_what_they_say(clock: Clock) -> None:
    uniform, adaptive = rows()["uniform", 16], rows()["adaptive", 16]
    assert adaptive.rmse == pytest.approx(uniform.rmse, rel=0.3)
    stage, (knob,) = SettingRenderer(ALL, WIDTH, HEIGHT, 1, inf), (knob for knob in KNOBS if knob.name == "adaptive")
    stage.prepare(knob).result()
    before = clock.packets
    stage.draw(Setting(knob, 16))
    once = packets(WIDTH, HEIGHT)
    assert 2 * once < clock.packets - before < 8 * once  # of 17, if all of the picture were done again
    assert adaptive.cpu_ms == pytest.approx((clock.packets - before) * PACKET_SECONDS * 1e3 * PROCESSOR_SHARE)
    assert rows()["single", 4].rmse == pytest.approx(rows()["uniform", 4].rmse, rel=0.05)
    assert rows()["single", 4].rmse != rows()["uniform", 4].rmse
    assert all(row.not_finite == 0 for row in rows().values())


def test_the_options_of_the_command_line_draw_the_picture_of_a_setting() -> None:
    """Settings that no options draw have none."""
    assert rows()["adaptive", 16].options == ""
    for key in (("uniform", 4), ("single", 4), ("auto", 0.01)):
        options = argument_parser().parse_args(rows()[key].options.split())
        how = {"samples": options.samples, "precision": options.precision, "error": options.error}
        made = minirt.render(ALL, WIDTH, HEIGHT, **{name: value for name, value in how.items() if value}).linear
        assert made is not None
        assert rows()[key].rmse == pytest.approx(error(np.clip(made, 0, 1), right().picture), rel=1e-9)


def test_bounces_are_a_knob_of_scenes_that_have_them() -> None:
    floor, ball, *_ = SHAPES
    mirrors = Scene((AMBIENT, EYE, LAMP, floor.replace(mirror=0.5), ball.replace(mirror=0.9)))
    plain, names = (list({each.knob.name: 0 for each in settings(scene, 16, 0.0)}) for scene in (ALL, mirrors))
    assert plain == ["uniform", "adaptive", "auto", "single"]
    assert names == [*plain[:3], "no bounces", "1 bounce", "3 bounces"]
    right = reference(mirrors, WHOLE, 256, seed=3)
    wanted = [setting for setting in settings(mirrors, 16, 1.0) if setting.value == 16]
    rmse = {row.knob: row.rmse for row in rows_for(*wanted, scene=mirrors, near=right)}
    assert rmse["no bounces"] > 2 * rmse["1 bounce"] > 4 * rmse["3 bounces"] > 4 * rmse["uniform"]


def test_light_that_is_not_finite_is_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two lights brighter than any file may say: where both shine straight down, their sum is infinite."""
    bright = Scene((AMBIENT, EYE, LAMP, FurtherLight(LAMP.position, 1.0), *SHAPES))
    monkeypatch.setattr(
        lights, "positions_and_intensities", lambda lamps, _: np.array([[-4, 6, -5, 1.7e308, 1, 1]] * len(lamps))
    )
    rows = rows_for(*settings(bright, 4, 1.0), scene=bright)
    counts = {(row.knob, int(row.label)): row.not_finite for row in rows}
    assert 0 < counts["uniform", 1] < WIDTH * HEIGHT
    assert counts["uniform", 4] == pytest.approx(4 * counts["uniform", 1], rel=0.05)
    assert counts["uniform", 1] < counts["adaptive", 4] < counts["uniform", 1] + counts["uniform", 4]
    assert all(isfinite(row.rmse) for row in rows)


def test_a_setting_that_fails_stays_as_nan() -> None:
    def fails(*_: object) -> Drawn:
        raise RenderError("no room")

    failed, good = rows_for(Setting(Knob("bad", "", draw=fails), 1), Setting(KNOBS[0], 1))
    assert isnan(failed.rmse)
    assert isnan(failed.ms)
    assert failed.remark == "failed: no room"
    assert good.rmse > 0


def test_a_setting_that_takes_long_is_run_once_and_one_that_would_take_far_too_long_not_at_all() -> None:
    """By processor time, which other programs hardly change; the time of one run is a time, too."""
    wanted, once = [Setting(KNOBS[0], samples) for samples in (1, 4)], ONCE * PROCESSOR_SHARE
    left_out = f"left out: {4 * once:.2g} s"
    for longest, remarks in (
        (3.9 / LEFT_OUT * once, (ONE_RUN, left_out)),
        (0.9 * once, (ONE_RUN, ONE_RUN)),
        (3.9 * once, ("", ONE_RUN)),
        (4.1 * once, ("", "")),
    ):
        made = rows_for(*wanted, longest=longest)
        assert tuple(row.remark for row in made) == remarks
        for row, remark in zip(made, remarks, strict=True):
            assert isnan(row.ms) if remark == left_out else row.ms == pytest.approx(row.samples * ONCE * 1e3)
            assert row.runs == {"": FEW, ONE_RUN: 1, left_out: 0}[remark]


def test_a_slow_moment_does_not_make_a_setting_one_that_takes_long(
    clock: Clock, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The first picture takes five times as long as usual."""
    wanted, measured = [Setting(KNOBS[0], samples) for samples in (1, 2)], SettingRenderer.measured

    def at_first(self: SettingRenderer, setting: Setting, near: ReferencePicture) -> object:
        clock.slowness = 5.0 if setting is wanted[0] else 1.0
        found = measured(self, setting, near)
        clock.slowness = 1.0
        return found

    monkeypatch.setattr(SettingRenderer, "measured", at_first)
    for row in rows_for(*wanted, longest=2.1 * ONCE * PROCESSOR_SHARE):
        assert (row.runs, row.remark) == (FEW, "")
        assert row.ms == pytest.approx(row.samples * ONCE * 1e3)


def test_automatic_sampling_tells_what_was_asked_and_its_own_estimate() -> None:
    row = rows()["auto", 0.005]
    assert row.asked == 0.005
    assert 0 < row.estimated <= 0.005
    assert row.rmse == pytest.approx(row.estimated, rel=0.5)
    assert 1 < row.samples < 64
    assert [setting.value for setting in settings(ALL, 1, 0.002) if setting.knob is AUTO] == [0.01, 0.005, 0.003, 0.002]
    assert isnan(rows()["uniform", 4].asked)


def test_the_error_in_8_bits_is_that_of_the_file() -> None:
    """Rounding adds its own error, independent of that of the samples: a twelfth of a squared level."""
    for samples in (1, 16):
        row = rows()["uniform", samples]
        file = minirt.render(ALL, WIDTH, HEIGHT, samples=samples).array / 255
        assert row.rmse_8_bits == pytest.approx(error(file, right().picture), rel=1e-9)
        assert row.rmse_8_bits == pytest.approx((row.rmse**2 + 1 / 255**2 / 12) ** 0.5, rel=0.05)
