"""Make and break of a relay contact under FMPy: bounce over the speed of the actuator and the damping of the contact.

An actuator moves the fixed contact (input support.displacement). It approaches the spring at rest across a gap at a
constant speed v, passes the point of touch and half of the overtravel s, and is stopped by a constant deceleration
v**2/s over the other half. After 10 ms it returns the same way. The input is linear over each communication step, so
that travel at a constant speed is exact in a step of any length; the parabolas are polygons of 1000 pieces: with 100,
the kinks themselves open a heavily damped contact at 0.2 m/s.

The identified contact damping of the specimen, 80.63 us, prevents bounce on make below 0.2 m/s; clean metal has less,
so it is varied.

Interruption: the contact resistance is above 60 Ohm (chatter.resistanceThreshold) for --minimum or longer. Bounces on
make: interruptions after the first touch. Bounce time: from the first touch to the last closing before the actuator
returns; 0 without bounce. Break time: from the start of the return to the last separation. Bounces on break:
interruptions after that start which end again. The component measures them within its steps.
"""

import itertools
from dataclasses import dataclass
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, LogNorm
from tqdm import tqdm

from common import parser, read_arguments, save
from relay_contact import Array, Component, Values, write_table
from relay_contact.figures import BLUE, GREY, ORANGE, RED

REST = 0.01  # s, the contact comes to rest within 1 ms
PIECES = 1000  # of a parabola
TOUCH = 1e-6  # s after the first touch, a step ends: no bounce is that short
SHOWN = ("contact.force", "contact.indentation")
COUNTED = ("chatter.count", "contact.lastClosing", "chatter.totalInterruption", "contact.lastOpening")


def course(gap: float, overtravel: float, speed: float) -> tuple[Array, Array, float]:
    """Give times (s) and positions (m) of the actuator for a gap, an overtravel (m) and a speed (m/s), and the start of
    its return (s).
    """  # noqa: D205
    half = overtravel / 2
    reach = (gap + half) / speed
    brake = np.linspace(0, 2 * half / speed, PIECES + 1)  # the mean speed is half
    travelled = speed * brake - 0.5 * speed**2 / overtravel * brake**2
    touch = gap / speed + TOUCH
    make = np.concatenate([[0, touch], reach + brake])
    position = np.concatenate([[0, speed * touch], gap + half + travelled])
    start = make[-1] + REST
    # The return is the reverse, except for the touch.
    back = start + (make[-1] - np.delete(make, 1)[::-1])
    time = np.concatenate([make, back, [back[-1] + REST]])
    position = np.concatenate([position, np.delete(position, 1)[::-1], [0]])
    return time, position, start


SPEED, DAMPING, TOUCHED = "speed [m/s]", "contact.damping [s]", "first touch [s]"
BOUNCES, TIME, OPEN = "bounces on make", "bounce time [s]", "open while bouncing [s]"
LARGEST, BREAK, AGAIN = "largest force [N]", "break time [s]", "bounces on break"
"""Columns of the table: a make and a break."""

Outcome = dict[str, float]


@dataclass
class Relay:
    """What is the same in all runs, SI units."""

    component: Component
    gap: float
    overtravel: float
    minimum: float
    """Shortest interruption that counts as a bounce."""

    def run(self, speed: float, damping: float, sample: float | None = None) -> tuple[Outcome, Array]:
        """Make and break (m/s, s); give also rows of time, force (N) and indentation (m) at every step.

        Steps are the pieces of the course, cut into shorter ones where a sample time (s) is given.
        """
        corners, positions, back = course(self.gap, self.overtravel, speed)
        time = corners
        if sample:
            time = np.union1d(time, np.arange(0, time[-1], sample))
            time = time[np.diff(time, prepend=-1) > 1e-9]
        position = np.interp(time, corners, positions)
        values: Values = {
            "contact.overtravel": -self.gap,
            "contact.damping": damping,
            "effects.axialForce": "None",
            "chatter.minimumDuration": self.minimum,
        }
        with self.component.started(values) as contact:
            first = contact.real(*SHOWN)
            rows = contact.drive(time, {"support.displacement": position}, [*SHOWN, *COUNTED, "step.maximumForce"])
        made, last = int(np.searchsorted(time, back)) - 1, -1  # the last step before the return, and of all
        (count, closing, interrupted, _), (broken, _, _, opening) = (
            [float(rows[name][at]) for name in COUNTED] for at in (made, last)
        )
        touches = rows["contact.lastClosing"]
        touch, largest = float(touches[touches >= 0][0]), float(rows["step.maximumForce"].max())
        # The gap before the first touch, if it lasts, is an interruption too, and so is the last separation.
        before = touch >= self.minimum
        bounces = int(count) - before
        times = (closing - touch, interrupted - before * touch) if bounces else (0.0, 0.0)
        again = int(broken - count) - 1
        outcome = {
            SPEED: speed, DAMPING: damping, TOUCHED: touch, BOUNCES: bounces, TIME: times[0], OPEN: times[1],
            LARGEST: largest, BREAK: opening - back, AGAIN: again,
        }  # fmt: skip
        columns = [np.append(start, rows[name]) for name, start in zip(SHOWN, first, strict=True)]
        return outcome, np.column_stack([time, *columns])


def edges(centres: Array) -> Array:
    """Give the edges of cells at equal ratios."""
    ratio = (centres[1] / centres[0]) ** 0.5
    return np.append(centres / ratio, centres[-1] * ratio)


def draw_map(axes: Axes, outcomes: pd.DataFrame, name: str, title: str) -> None:
    """Draw outcomes over speed and damping: numbers of bounces in as many colours, times (s) on a logarithmic scale."""
    grid, counts = outcomes.pivot(index=DAMPING, columns=SPEED, values=name), name != TIME
    most = max(int(outcomes[name].max()), 1)
    norm = BoundaryNorm(np.arange(most + 2) - 0.5, 256) if counts else LogNorm()
    shown = grid if counts else np.ma.masked_equal(1e6 * grid, 0)
    axes.set_facecolor("#E5E5E5")
    sides = 1e3 * edges(grid.columns.to_numpy()), 1e6 * edges(grid.index.to_numpy())
    mesh = axes.pcolormesh(*sides, shown, cmap="cividis", norm=norm)
    bar = axes.figure.colorbar(mesh, ax=axes, pad=0.02)
    if counts:
        bar.set_label("bounces")
        bar.set_ticks([float(tick) for tick in range(0, most + 1, 1 + most // 10)])
        bar.ax.minorticks_off()
    else:
        bar.set_label("bounce time [µs]")
        bar.ax.yaxis.set_major_formatter("{x:g}")
    axes.set(xlabel="speed of the actuator [mm/s]", ylabel="contact damping [µs]", title=title)
    axes.set(xscale="log", yscale="log")


def draw(path: Path, relay: Relay, outcomes: pd.DataFrame, shown: Outcome, rows: Array) -> None:
    """Draw the courses of one make and break, and the maps."""
    figure, ((make, count, length), (open_, delay, again)) = plt.subplots(2, 3, figsize=(14, 8), layout="constrained")
    time, force, indentation = rows.T
    since = 1e6 * (time - shown[TOUCHED])
    near = (since > -40) & (since < max(250, 1.5e6 * shown[TIME]))
    make.plot(since[near], force[near], color=BLUE, label="contact force")
    across = make.get_xaxis_transform()
    make.fill_between(since[near], 0, 1, where=force[near] <= 0, color=RED, alpha=0.2, transform=across, lw=0)
    make.fill_between([], [], color=RED, alpha=0.2, label="open")
    make.set(xlabel="time after the first touch [µs]", ylabel="contact force [N]", title="Make")
    since = 1e3 * (time - course(relay.gap, relay.overtravel, shown[SPEED])[2])
    last = 1e3 * shown[BREAK]
    near = (since > last - 2) & (since < last + 4)
    open_.plot(since[near], -1e6 * indentation[near], color=BLUE, label="gap between the contacts")
    open_.axvline(last, color=RED, linestyle="--", label="last separation")
    open_.set(xlabel="time after the actuator starts back [ms]", ylabel="gap [µm]", title="Break")
    for axes in (make, open_):
        axes.legend(fontsize="small", frameon=False)
    draw_map(count, outcomes, BOUNCES, "Make: number of bounces")
    draw_map(length, outcomes, TIME, "Make: bounce time (grey: no bounce)")
    draw_map(again, outcomes, AGAIN, "Break: number of bounces")
    dampings, speeds = outcomes[DAMPING].unique(), outcomes[SPEED].unique()
    for damping, colour in zip(dampings[[0, len(dampings) // 2, -1]], (BLUE, ORANGE, RED), strict=True):
        delays = 1e3 * outcomes[BREAK][outcomes[DAMPING] == damping]
        delay.plot(1e3 * speeds, delays, ".-", color=colour, label=f"damping {1e6 * damping:.3g} µs")
    passing = 1.5 * relay.overtravel / speeds
    delay.plot(1e3 * speeds, 1e3 * passing, "--", color=GREY, label="actuator passes the spring's rest position")
    delay.set(xscale="log", yscale="log", xlabel="speed of the actuator [mm/s]", ylabel="break time [ms]")
    delay.set_title("Break: from the actuator's start to the last separation")
    delay.legend(fontsize="small", frameon=False)
    for axes in (make, open_, delay):
        axes.grid(alpha=0.3)
    for axes in (count, length, delay, again):
        axes.xaxis.set_major_formatter("{x:g}")
        axes.yaxis.set_major_formatter("{x:g}")
    for axes in (count, length, again):
        axes.plot(1e3 * shown[SPEED], 1e6 * shown[DAMPING], "x", color="white", markersize=8, markeredgewidth=2)
    figure.suptitle(
        f"Relay contact, gap {1e6 * relay.gap:g} µm, overtravel {1e6 * relay.overtravel:g} µm. Left, and crosses: "
        f"{1e3 * shown[SPEED]:g} mm/s, contact damping {1e6 * shown[DAMPING]:g} µs. "
        f"A bounce is an interruption of {1e6 * relay.minimum:g} µs or more."
    )
    save(figure, path, dpi=130)


def main() -> None:
    """Run the map."""
    given = read_arguments(parser(
        __doc__, "6 speeds and 4 dampings instead of 24 and 13", "about half a minute",
        gap=(20.0, 1.0, 5000.0, "µm", "gap before the make"),
        overtravel=(200.0, 10.0, 5000.0, "µm", "travel after the first touch"),
        minimum=(1.0, 0.01, 1000.0, "µs", "shortest interruption that counts as a bounce"),
        speed=(60.0, 1.0, 500.0, "mm/s", "speed of the courses shown"),
        damping=(1.0, 0.0, 1000.0, "µs", "contact damping of the courses shown"),
    ))  # fmt: skip
    speeds = 1e-3 * np.geomspace(5, 400, 6 if given.quick else 24)
    dampings = 1e-6 * np.geomspace(0.1, 100, 4 if given.quick else 13)
    relay = Relay(Component(given.fmu), 1e-6 * given.gap, 1e-6 * given.overtravel, 1e-6 * given.minimum)
    shown, rows = relay.run(1e-3 * given.speed, 1e-6 * given.damping, sample=2e-6)
    found = []
    for speed, damping in (bar := tqdm(list(itertools.product(speeds, dampings)), unit="make and break")):
        bar.set_description(f"{1e3 * speed:5.1f} mm/s, {1e6 * damping:6.2f} µs", refresh=False)
        found.append(relay.run(float(speed), float(damping))[0])
    outcomes = pd.DataFrame(found)
    paths = [given.out / name for name in ("closing-bounce.csv", "closing-bounce-course.csv", "closing-bounce.png")]
    pd.DataFrame([shown, *found]).to_csv(paths[0], index=False, float_format="%.12g")
    write_table(paths[1], "time [s],contact.force [N],contact.indentation [m]", rows)
    draw(paths[2], relay, outcomes, shown, rows)
    print(f"{given.speed:g} mm/s, contact damping {given.damping:g} µs")
    touch = f"first touch after {1e6 * shown[TOUCHED]:.3f} µs, largest force {shown[LARGEST]:.2f} N"
    bounced = f"for {1e6 * shown[TIME]:.2f} µs, open for {1e6 * shown[OPEN]:.2f} µs of it"
    print(f"make: {touch}, bounces {shown[BOUNCES]}, {bounced}")
    print(f"break: bounces {shown[AGAIN]}, last separation after {1e3 * shown[BREAK]:.3f} ms")
    most, calm = max(found, key=lambda each: each[TIME]), sum(each[BOUNCES] == 0 for each in found)
    where = f"{1e3 * most[SPEED]:.3g} mm/s, {1e6 * most[DAMPING]:.3g} µs"
    print(f"map: longest bounce time {1e6 * most[TIME]:.1f} µs at {where}, none in {calm} of {len(outcomes)}")
    print(*paths, sep="\n")


if __name__ == "__main__":
    main()
