"""The command `relay-contact`."""

import argparse
import gc
import math
import sys
import warnings
import webbrowser
from collections.abc import Callable
from datetime import date
from io import TextIOWrapper
from pathlib import Path
from typing import Any

import numpy as np

from relay_contact.component import Component, Value, units
from relay_contact.files import RelayContactError, at_once, digest, fmu_path, page_path, read_toml, scenes, spare
from relay_contact.scene import Scene, run, write_table
from relay_contact.spring import SPRING_FILES

EXAMPLES = """examples:
  relay-contact list                                   scenes, relays and standards included
  relay-contact list --relay paper                     is its contact smooth enough for Hertz's law?
  relay-contact list --variables excitation            variables whose names contain a text, with unit and start value
  relay-contact run paper-1khz                         writes paper-1khz.csv and paper-1khz.png
  relay-contact run chatter-41g --set excitation.frequency=1250 --output contact.voltage
  relay-contact ssv paper-1khz --plain                 what the scene changes, for tools that read SSP 1.0
  relay-contact explore                                a page with sliders in the browser; no server, no network
  relay-contact qualify paper --standard MIL-PRF-28776  verdicts and margins, qualification.html
  relay-contact qualify paper --history road.csv        margin on a measured acceleration
  relay-contact compare chatter-41g.csv log.csv        interruptions simulated and measured
  relay-contact identify paper --data force.csv ring.csv  damping, rivet, overtravel from measurements
"""

TOLD = ["contact.lastOpening", "contact.lastClosing", "chatter.count", "chatter.longestInterruption", "solver.steps"]
"""Outputs whose last value is printed."""
LONGEST = 150
"""Bytes of what is changed in the name of a table."""
IDENTIFY = """Find overtravel, stiffness, rivet mass and damping of a relay from measurements, with intervals.
Write them into a copy of the relay's file, and onto a page. The columns of a file say what was measured, in which unit:

  travel [mm],force [cN]                          static force over travel from the working position
  time [ms],displacement [um]                     ring-down of the spring off its contact (or velocity; or force)
  frequency [Hz],acceleration [g],force [cN]      frequency response (or displacement, velocity)
  overtravel [mm],frequency [Hz]                  lowest frequency of the closed contact over overtravel
  frequency [Hz],level [g]                        level of a sine at which the contact begins to chatter
  speed [mm/s],bounce [us]                        length of the first bounce after closing at a constant speed

Lines before the columns may say: # position = coil energised   # contact = closed   # calibration = 0.01
or set a parameter of the component for this measurement: # chatter.minimumDuration = 1e-6
"""


def list_all(given: argparse.Namespace) -> None:
    """Print variables, what the contact of a relay is like, or the files included."""
    if given.variables is not None:
        list_variables(Component(given.fmu), given.variables)
        return
    if given.relay:
        from relay_contact.qualification.relay import Relay
        from relay_contact.qualification.roughness import told

        component = Component(given.fmu)
        relay = Relay.read(given.relay, component)
        print(f"{relay.title}:", *told(component, relay), sep="\n  ")
        return
    print(f"component: {given.fmu}")
    from relay_contact.qualification import relays, standards

    for kind, files in (("scenes", scenes()), ("relays", relays()), ("standards", standards())):
        print(f"\n{kind}:")
        width = max(map(len, files), default=0)
        for name, path in files.items():
            print(f"  {name:{width}}  {read_toml(path).get('title', '')}")


def list_variables(component: Component, text: str) -> None:
    """Print the variables whose names contain a text."""
    shown = units(component.description)
    chosen = {name: each for name, each in component.variables.items() if text.lower() in name.lower()}
    if not chosen:
        raise RelayContactError(f"--variables {text}: no variable has this in its name")
    for name, variable in chosen.items():
        what = variable.causality
        if what in ("parameter", "input"):
            what += f" {component.start(name)}"
        unit = shown[name].si if name in shown else ""
        choices = f" [{', '.join(component.choices(name))}]" if variable.type == "Enumeration" else ""
        print(f"{name} ({what}{f' {unit}' if unit else ''}){choices}: {variable.description or ''}")


def run_scene(given: argparse.Namespace) -> None:
    """Run a scene; write its outputs as a table (CSV, SI units) and as a figure (PNG)."""
    from relay_contact.plot import draw, sweep_of

    component = Component(given.fmu)
    changes: dict[str, Value] = {}
    words = []
    for text in given.set:
        name, equals, value = text.partition("=")
        if not equals:
            raise RelayContactError(f"--set {text}: must be NAME=VALUE")
        name = component.settable(name.strip())
        if name in changes:
            raise RelayContactError(f"--set {text}: {name} is given twice")
        value = value.strip()
        changes[name] = component.read(name, value)
        carried = Path(component.folder) / "resources" / value
        if name in SPRING_FILES and value and (Path(value).is_file() or not carried.is_file()):
            # Relative to where the command runs; its name alone is in those of table and figure.
            changes[name], value = str(Path(value).resolve()), Path(value).name
        words.append(f"{name}={value}")
    scene = Scene.read(given.scene, component).changed(component, changes)
    # The title tells of the scene as it is in its file.
    titled = f"{scene.title}{'; changed: ' if words else ''}{', '.join(words)}"
    names = list(dict.fromkeys([*scene.outputs, *(component.name(name) for name in given.output)]))
    told = list(dict.fromkeys([*names, *TOLD]))
    stem, changed = Path(given.scene).stem, ",".join(words)
    # More than a file system takes.
    changed = changed if len(changed.encode()) < LONGEST else digest(changed.encode())
    table = given.out / f"{stem}{',' if words else ''}{changed}.csv"
    spare([table], [scene.file] if scene.file else [])
    given.out.mkdir(parents=True, exist_ok=True)
    result = run(scene, outputs=told, stop=given.stop, step=given.step, component=component, progress=True)
    columns = ["time", *names]
    write_table(table, ",".join(columns), np.column_stack([result[name] for name in columns]))
    print(titled, "Ranges at communication points; step.* have the extremes between them:", sep="\n")
    width = max(map(len, result.columns))
    for name in names:
        values = result[name]
        print(f"  {name:{width}}  {values.min():.6g} to {values.max():.6g} {result.units[name]}".rstrip())
    for name in TOLD:
        print(f"  {name:{width}}  {result[name][-1]:.9g} {result.units[name]}".rstrip() + " at the end")
    print(table, draw(table, titled, sweep_of(scene.values)), sep="\n")


def write_parameters(given: argparse.Namespace) -> None:
    """Write the parameters that scenes change as parameter sets of SSP 1.0, NAME.ssv."""
    from relay_contact.ssp import parameter_set

    component = Component(given.fmu)
    given.out.mkdir(parents=True, exist_ok=True)
    for name in given.scene or scenes():
        path = given.out / f"{Path(name).stem}{'-plain' * given.plain}.ssv"
        with at_once(path) as part:
            part.write_bytes(parameter_set(Path(name).stem, Scene.read(name, component), component, given.plain))
        print(path)


def qualify_relay(given: argparse.Namespace) -> None:
    """Test a relay by a standard or a measured record. Write verdicts, margins and intervals as a page and tables."""
    # What is imported stays: garbage is sought in the rest.
    gc.disable()
    from relay_contact.qualification import qualify
    from relay_contact.qualification.page import FILES, PDF, UNKNOWN
    from relay_contact.qualification.words import HEAD, MARKS, UNREAD, rows

    asked = Path(given.standard or (*given.history, "")[0]).stem
    folder = given.out or Path(f"qualification-{Path(given.relay).stem}-{asked}")
    gc.freeze()
    gc.enable()
    found = qualify(
        given.relay, given.standard, out=folder, tests=given.test, history=given.history, unit=given.unit,
        rate=given.rate, quick=given.quick, workers=given.workers, cluster=given.cluster,
        component=Component(given.fmu), progress=True, date=given.date, pdf=given.pdf,
    )  # fmt: skip
    marks = [MARKS[tested.first.evidence] for tested in found]
    lines = [
        [tested.first.position, row[0] + mark, *row[1:]]
        for tested, mark in zip(found, marks, strict=True) for row in rows(tested)
    ]  # fmt: skip
    print_table([["position", *HEAD], *lines])
    left = "; ".join(test.name for test in found.standard.left)
    print(f"{found.standard.title}: {found.counts}{': ' if left else ''}{left}")
    notes = dict.fromkeys(note for tested in found for note in tested.notes)
    print(
        *(UNKNOWN,) * found.relay.is_certain,
        *(UNREAD,) * any(marks),
        *notes,
        *(folder / name for name in (*FILES, *(PDF,) * given.pdf)),
        sep="\n",
    )


def compare_runs(given: argparse.Namespace) -> None:
    """Compare a run with a chatter log or a measured resistance: counts, durations and a figure."""
    from relay_contact.comparison import HEAD, compare

    found = compare(given.run, given.measured, out=given.out, threshold=given.threshold, shift=given.shift)
    print_table([list(HEAD), *found.rows])
    print(*found.notes, *found.paths, sep="\n")


def identify_relay(given: argparse.Namespace) -> None:
    """Find parameters of a relay from measurements, and print them."""
    from relay_contact.identification import identify
    from relay_contact.identification.report import FILES, HEAD, cells, silent

    folder = given.out or Path(f"identification-{Path(given.relay).stem}")
    component = Component(given.fmu)
    result = identify(
        given.relay, given.data, out=folder, parameters=given.parameter, component=component, progress=True
    )
    print_table([list(HEAD), *cells(component, result)])
    print(*silent(result), folder / f"{result.path.stem}.toml", *(folder / name for name in FILES), sep="\n")


def explore(given: argparse.Namespace) -> None:
    """Open a page in the browser that simulates as sliders move: force, resistance, level that opens the contact."""
    page = page_path()
    if not page.is_file():
        raise RelayContactError("the page is not in this installation: `cargo xtask explore` builds it")
    print(page.as_uri())
    if not given.print:
        webbrowser.open(page.as_uri())


def print_table(rows: list[list[str]]) -> None:
    """Print texts in columns."""
    widths = [max(map(len, column)) + 2 for column in zip(*rows, strict=True)]
    for row in rows:
        print("".join(f"{cell:{width}}" for cell, width in zip(row, widths, strict=True)).rstrip())


def plot_table(given: argparse.Namespace) -> None:
    """Draw a table of outputs, such as `relay-contact run` writes, beside it as PNG."""
    from relay_contact.plot import draw

    print(draw(given.table, given.table.stem))


def finite(text: str) -> float:
    """Return a number of the command line."""
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise argparse.ArgumentTypeError(f"{text}: not allowed, allowed is a finite number")
    return number


def positive(text: str) -> float:
    """Return a number of the command line that is greater than 0."""
    number = finite(text)
    if number <= 0:
        raise argparse.ArgumentTypeError(f"{text}: not allowed, allowed is a number greater than 0")
    return number


def line() -> argparse.ArgumentParser:
    """Return the command line."""
    whole = argparse.ArgumentParser(
        prog="relay-contact", description="A relay contact under vibration and shock: does it open, and for how long?",
        epilog=EXAMPLES, formatter_class=argparse.RawDescriptionHelpFormatter,
    )  # fmt: skip
    commands = whole.add_subparsers(dest="command", required=True, metavar="COMMAND")
    common = argparse.ArgumentParser(add_help=False)
    common.add_argument("--fmu", type=Path, default=fmu_path(), help="another component (%(default)s)")

    def command(name: str, act: Callable[[argparse.Namespace], None], text: str, **more: Any) -> Callable[..., Any]:  # noqa: ANN401
        """Add a command, described by what acts unless otherwise; return what adds arguments to it."""
        one = commands.add_parser(name, help=text, **({"parents": [common], "description": act.__doc__} | more))
        one.set_defaults(act=act)
        return one.add_argument

    add = command("list", list_all, "list scenes, relays and standards, or variables", description=None)
    add("--variables", nargs="?", const="", metavar="TEXT", help="variables with TEXT in their names, or all")
    text = "only the contact of this relay: its size, and whether it is smooth enough for Hertz's law"
    add("--relay", metavar="FILE", help=text)

    add = command("run", run_scene, "run a scene: table and figure")
    add("scene", help="name of a scene, as `relay-contact list` prints them, or path of a scene file of your own")
    text = "another value for a parameter or a constant input, SI units; may be repeated"
    add("--set", action="append", default=[], metavar="NAME=VALUE", help=text)
    text = "a further output, as `relay-contact list --variables` prints them; may be repeated"
    add("--output", action="append", default=[], metavar="NAME", help=text)
    add("--stop", type=positive, metavar="SECONDS", help="end of the run (the scene's)")
    add("--step", type=positive, metavar="SECONDS", help="communication step (the scene's)")
    add("--out", type=Path, default=Path(), metavar="FOLDER", help="folder for what is written (the current one)")

    add = command("qualify", qualify_relay, "test a relay by a standard or a record")
    add("relay", help="name of a relay, as `relay-contact list` prints them, or path of a relay file of your own")
    add("--standard", metavar="NAME", help="name of a standard, or path of a file of your own")
    text = "a measured acceleration as a test: CSV, MDF4, UFF58, TDMS or .mat, each channel by itself; may be repeated"
    add("--history", action="append", default=[], metavar="FILE", help=text)
    add("--unit", choices=["g", "m/s2"], default="", help="unit of a record that does not state it")
    add("--rate", type=positive, metavar="HZ", help="samples a second of a record without time")
    text = "only tests with TEXT in their names; may be repeated"
    add("--test", action="append", default=[], metavar="TEXT", help=text)
    add("--quick", action="store_true", help="fewer frequencies in the figures; the margins are the same")
    add("--workers", type=int, metavar="COUNT", help="threads that run tests side by side (one for each core)")
    text = "of a Dask cluster whose workers have this package, such as tcp://host:8786"
    add("--cluster", metavar="ADDRESS", help=text)
    add("--pdf", action="store_true", help="the page as PDF, too (pip install 'relay-contact[pdf]')")
    text = "date to write on the page, today's if none follows; without it each run writes the same bytes"
    add("--date", nargs="?", const=date.today().isoformat(), default="", metavar="DATE", help=text)
    text = "folder for what is written (qualification-RELAY-STANDARD); finished tests found there are not run again"
    add("--out", type=Path, metavar="FOLDER", help=text)

    add = command("ssv", write_parameters, "write scenes as SSP parameter sets")
    add("scene", nargs="*", help="names or files of scenes; without them all scenes included")
    add("--plain", action="store_true", help="for the component in which all numbers are Reals: NAME-plain.ssv")
    add("--out", type=Path, default=Path(), metavar="FOLDER", help="folder for what is written (the current one)")

    raw, text = argparse.RawDescriptionHelpFormatter, "find parameters of a relay from measurements"
    add = command("identify", identify_relay, text, description=IDENTIFY, formatter_class=raw)
    add("relay", help="name of a relay, as `relay-contact list` prints them, or path of a relay file of your own")
    add("--data", required=True, nargs="+", metavar="CSV", help="files of measurements")
    text = "find this one instead of the usual ones; may be repeated; spring.thickness: an entry of the spring file"
    add("--parameter", action="append", metavar="NAME", help=text)
    add("--out", type=Path, metavar="FOLDER", help="folder for what is written (identification-RELAY)")

    add = command("explore", explore, "simulate in the browser, with sliders", parents=[])
    add("--print", action="store_true", help="only print its address")

    add = command("compare", compare_runs, "compare a run with a measurement", parents=[])
    add("run", type=Path, help="table of `relay-contact run`, with contact.resistance")
    add("measured", type=Path, help="CSV: start and duration of interruptions, or time and resistance")
    text = "resistance [Ohm] above which the contact is interrupted (%(default)g)"
    add("--threshold", type=positive, default=60.0, metavar="OHM", help=text)
    text = "time [s] to add to the measured one; without it both are aligned at their first interruption"
    add("--shift", type=finite, metavar="SECONDS", help=text)
    add("--out", type=Path, default=Path(), metavar="FOLDER", help="folder for what is written (the current one)")

    add = command("plot", plot_table, "draw a table of outputs")
    add("table", type=Path, help="CSV file with a column `time`")
    return whole


def main(arguments: list[str] | None = None) -> int:
    """Run the command."""
    if isinstance(sys.stdout, TextIOWrapper):
        # Where it goes to a file, an encoding may lack signs of units.
        sys.stdout.reconfigure(errors="backslashreplace")
    given = line().parse_args(arguments)
    try:
        with warnings.catch_warnings():
            warnings.showwarning = lambda message, *_: print(f"relay-contact: warning: {message}", file=sys.stderr)
            given.act(given)
    except BrokenPipeError:
        # Whoever read what was printed has enough.
        sys.stdout = None
        return 0
    except KeyboardInterrupt:
        print("\nrelay-contact: interrupted", file=sys.stderr)
        return 130
    except (RelayContactError, OSError) as error:
        told = f"{error.filename}: {error.strerror}" if isinstance(error, OSError) and error.filename else error
        print(f"relay-contact: {told}", file=sys.stderr)
        return 1
    return 0
