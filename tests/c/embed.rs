//! The examples that use the library from a loop of their own, `embed.rs` and `embed.c`: run as their users do. Both print
//! the same numbers; force, circuit and interruptions are checked against closed forms.

use std::f64::consts::TAU;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::LazyLock;

use nalgebra::{Complex, Matrix3, Vector3};
use relay_contact::reference::{self, Model};
use relay_contact::scene::Scene;
use relay_contact::variables::VARIABLES;

use crate::program;

/// Communication step of the examples, s.
const STEP: f64 = 2e-6;

fn in_rust() -> Command {
    let mut command = Command::new(env!("CARGO"));
    command
        .args(["run", "--quiet", "--example=embed", "--"])
        .current_dir(env!("CARGO_MANIFEST_DIR"));
    command
}

fn in_c() -> Command {
    static PROGRAM: LazyLock<PathBuf> = LazyLock::new(|| program::compile("examples/embed.c"));
    program::command(&PROGRAM)
}

fn output(mut program: Command, arguments: &[&str]) -> Output {
    program.args(arguments).output().unwrap()
}

/// What a run gave: the lines printed, but for the last two with speed and path, and the rows of the table.
struct Run {
    lines: Vec<String>,
    rows: Vec<[f64; 6]>,
}

impl Run {
    fn new(program: Command, acceleration: &str, duration: &str, table: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(table);
        let ran = output(program, &[acceleration, duration, path.to_str().unwrap()]);
        let errors = String::from_utf8_lossy(&ran.stderr);
        assert!(ran.status.success(), "{errors}");
        let said = String::from_utf8(ran.stdout).unwrap();
        let mut lines: Vec<_> = said.lines().map(str::to_owned).collect();
        assert_eq!(lines.pop().unwrap(), path.to_str().unwrap());
        assert!(lines.pop().unwrap().ends_with(" per step"), "{said}");

        let text = fs::read_to_string(&path).unwrap();
        let (head, rows) = text.split_once('\n').unwrap();
        assert_eq!(
            head,
            "time,base.acceleration,contact.force,contact.resistance,contact.voltage,load.current [A]"
        );
        let row = |line: &str| {
            let values: Vec<f64> = line.split(',').map(|value| value.parse().unwrap()).collect();
            values.try_into().unwrap()
        };
        Self {
            lines,
            rows: rows.lines().map(row).collect(),
        }
    }

    /// The number on a line of the summary.
    fn number(&self, name: &str) -> f64 {
        let rest = self.lines.iter().find_map(|line| line.strip_prefix(name)).unwrap();
        rest.split_whitespace().next().unwrap().parse().unwrap()
    }
}

/// The model of the examples.
fn model() -> Model {
    let mut scene = Scene::default();
    scene.contact.overtravel = 0.19e-3;
    Model::new(&scene, 0.0).unwrap()
}

#[test]
fn both_languages_give_the_same_numbers() {
    let rust = Run::new(in_rust(), "400", "0.006", "embed-rust.csv");
    let c = Run::new(in_c(), "400", "0.006", "embed-c.csv");
    assert_eq!(rust.lines, c.lines);
    assert_eq!(rust.rows.len(), 3000);
    // Written so that they are read as the same bits.
    assert_eq!(rust.rows, c.rows);
    // A run in which there is something to take back.
    assert!(rust.number("steps done again: ") >= 4.0, "{:?}", rust.lines);
}

#[test]
fn a_small_vibration_gives_the_linear_response() {
    let (amplitude, model) = (0.5, model());
    let run = Run::new(in_rust(), &amplitude.to_string(), "0.015", "embed-small.csv");
    // A sin(950 Hz) sin(50 Hz) is half of cos(900 Hz) less half of cos(1000 Hz).
    let responses = [(900.0, 0.5), (1000.0, -0.5)].map(|(frequency, part)| {
        (
            TAU * frequency,
            reference::response(&model, TAU * frequency).force * part,
        )
    });
    let force = |time: f64| {
        let turned = responses.map(|(omega, force)| (force * Complex::new(0.0, omega * time).exp()).re);
        model.preload().force + amplitude * (turned[0] + turned[1])
    };
    let scale = amplitude * responses[0].1.norm().max(responses[1].1.norm()) * 2.0;
    // What rings from the start has gone after 10 ms: the damping of the first mode is some 3000 1/s. The law of the
    // contact departs from its tangent by about the amplitude over the preload, here 0.2 %. An acceleration held over
    // the steps would come half a step late, 0.6 % of the amplitude.
    assert!(scale < 2e-3 * model.preload().force);
    let worst = run.rows[5000..]
        .iter()
        .map(|row| (row[2] - force(row[0])).abs())
        .fold(0.0, f64::max);
    assert!(worst < 2e-3 * scale, "{worst} N of {scale} N");
}

#[test]
fn the_circuit_swings_as_its_equations_say_while_the_contact_is_open() {
    let run = Run::new(in_rust(), "400", "0.006", "embed-open.csv");
    let [_, _, _, resistance, voltage, current] = run.rows[0];
    // Before anything moves it is at rest.
    assert!((current - 6.0 / (60.0 + resistance)).abs() < 1e-6 * current);
    assert!((voltage - current * resistance).abs() < 1e-6 * voltage);

    let start = run.rows.iter().position(|row| row[2] == 0.0).unwrap();
    let open: Vec<_> = run.rows[start..].iter().take_while(|row| row[2] == 0.0).collect();
    assert!(open.len() > 15);
    // L di/dt = 6 V - (60 + 47) Ohm i - u, C du/dt = i; the contact's own 1 GOhm is nothing beside the quench.
    let rates = Matrix3::new(
        -107.0 / 1e-3,
        -1.0 / 1e-3,
        6.0 / 1e-3, //
        1.0 / 220e-9,
        0.0,
        0.0, //
        0.0,
        0.0,
        0.0,
    );
    let first = Vector3::new(open[0][5], open[0][4] - 47.0 * open[0][5], 1.0);
    // Error of the trapezoidal rule: each step turns a mode exp(s t) of modulus exp(-r t) wrongly by |s h|^3 / 12, which
    // adds up to |s|^3 h^2 / (12 e r) of its amplitude at most, at t = 1/r. Two modes, and they are |s| over their
    // imaginary part times as large as what they add up to.
    let (s, r) = ((1.0_f64 / (1e-3 * 220e-9)).sqrt(), 107.0 / 2e-3);
    let error = s.powi(3) * STEP * STEP / (12.0 * 1.0_f64.exp() * r) * 2.0 * s / (s * s - r * r).sqrt();
    for (n, row) in open.iter().enumerate() {
        let at = (rates * (n as f64 * STEP)).exp() * first;
        let [_, _, _, _, voltage, current] = **row;
        assert!((current - at.x).abs() < error * 0.1, "{n}: {current} A, {at}");
        assert!(
            (voltage - (at.y + 47.0 * at.x)).abs() < error * 6.0,
            "{n}: {voltage} V, {at}"
        );
    }
}

#[test]
fn the_interruptions_printed_are_those_of_the_table() {
    let run = Run::new(in_rust(), "400", "0.006", "embed-interruptions.csv");
    let threshold = Scene::default().chatter.resistance_threshold;
    let above: Vec<_> = run.rows.iter().map(|row| row[3] > threshold).collect();
    let stretches = above
        .split(|above| !above)
        .map(<[bool]>::len)
        .filter(|length| *length > 3);
    let lengths: Vec<_> = stretches.collect();
    assert!(lengths.len() >= 2);
    assert_eq!(run.number("interruptions of 5 us or more: "), lengths.len() as f64);
    // The ends are between rows.
    let longest = 1e-6 * run.number("longest interruption: ") / STEP;
    let rows = *lengths.iter().max().unwrap() as f64;
    assert!(
        (rows - 1.0..=rows + 1.0).contains(&longest),
        "{longest} and {rows} steps"
    );
}

#[test]
fn wrong_arguments_end_with_a_message_and_a_code() {
    for program in [in_rust, in_c] {
        let help = output(program(), &["--help"]);
        assert!(help.status.success() && String::from_utf8_lossy(&help.stdout).contains("usage: embed ["));
        for (arguments, code, message) in [
            (["fast", "0.01"], 2, "ACCELERATION = fast: expected a number"),
            (["400", "-1"], 2, "DURATION = -1 s: allowed is 2e-6 to 10 s"),
            (
                ["nan", "0.01"],
                1,
                "base.acceleration = NaN m/s2: not allowed, allowed is -1000000000 to 1000000000",
            ),
        ] {
            let ran = output(program(), &arguments);
            let printed = String::from_utf8_lossy(&ran.stderr);
            assert_eq!(ran.status.code(), Some(code), "{printed}");
            assert!(printed.contains(message), "{printed}");
        }
    }
}

#[test]
fn the_header_names_every_variable() {
    let lines: Vec<_> = relay_contact::C_HEADER.lines().collect();
    for variable in &VARIABLES {
        let described = |line: &&str| line.contains(&format!("* `{}`, ", variable.name));
        let at = lines
            .iter()
            .position(described)
            .unwrap_or_else(|| panic!("{}", variable.name));
        let constant: String = variable.name.chars().filter(|c| *c != '.').collect();
        let defined: Vec<_> = lines[at + 2].split(' ').collect();
        let name = defined[1].strip_prefix("RELAY_CONTACT_").unwrap().replace('_', "");
        assert_eq!(name, constant.to_uppercase());
        assert_eq!(defined[2], format!("{}u", variable.value_reference));
    }
}
