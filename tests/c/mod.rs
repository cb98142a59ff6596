//! The library from C, through the generated header: programs have to compile without a warning, link and run. The examples
//! `embed.rs` and `embed.c` give the same numbers, those of the linear response where the vibration is small.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX, EXE_SUFFIX};
use std::f64::consts::TAU;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;

use nalgebra::Complex;
use relay_contact::reference::{self, Model};
use relay_contact::scene::Scene;
use relay_contact::variables::VARIABLES;
use testing::worst;

/// The program of `examples/embed.c`, compiled once for all tests, which run beside each other: linking makes a file that is no
/// program for a moment.
static IN_C: LazyLock<PathBuf> = LazyLock::new(|| {
    let libraries = libraries();
    assert!(libraries.join(format!("{DLL_PREFIX}relay_contact{DLL_SUFFIX}")).exists());
    let program = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("embed{EXE_SUFFIX}"));
    let compiler = Command::new("cc")
        // Rust rounds every operation; C may fuse a product and a sum, as clang does on Arm.
        .args(["-std=c99", "-ffp-contract=off"])
        .args(["-Wall", "-Wextra", "-Wpedantic", "-Werror", "-I"])
        .arg(env!("RELAY_CONTACT_INCLUDE"))
        .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/embed.c"))
        .arg("-L")
        .arg(libraries)
        .args(["-lrelay_contact", "-lm", "-o"])
        .arg(&program)
        .output()
        .expect("a C compiler that is called cc (Debian: apt install gcc)");
    assert!(compiler.status.success(), "{}", String::from_utf8_lossy(&compiler.stderr));
    program
});

/// Where cargo builds the dynamic library, beside the test.
fn libraries() -> PathBuf {
    std::env::current_exe().unwrap().parent().unwrap().to_path_buf()
}

fn in_c() -> Command {
    let mut command = Command::new(&*IN_C);
    // Cargo points this at a folder that may hold the library of an earlier build.
    command.env("LD_LIBRARY_PATH", libraries());
    command
}

fn in_rust() -> Command {
    let mut command = Command::new(env!("CARGO"));
    command.args(["run", "--quiet", "--example=embed", "--"]).current_dir(env!("CARGO_MANIFEST_DIR"));
    command
}

/// What an example printed, and the rows of its table.
fn run(mut program: Command, acceleration: &str, duration: &str, table: &str) -> (String, Vec<Vec<f64>>) {
    let path: PathBuf = Path::new(env!("CARGO_TARGET_TMPDIR")).join(table);
    let ran = program.args([acceleration, duration]).arg(&path).output().unwrap();
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
    let said = String::from_utf8(ran.stdout).unwrap().replace(path.to_str().unwrap(), "");
    let text = fs::read_to_string(&path).unwrap();
    let row = |line: &str| line.split(',').map(|value| value.parse().unwrap()).collect();
    (said, text.lines().skip(1).map(row).collect())
}

#[test]
fn both_languages_give_the_same_numbers() {
    let rust = run(in_rust(), "400", "0.006", "embed-rust.csv");
    let c = run(in_c(), "400", "0.006", "embed-c.csv");
    // Written so that they are read as the same bits.
    assert_eq!(rust, c);
    assert_eq!(rust.1.len(), 3000);
    // Interruptions are those of the table, and there are steps to take back.
    let threshold = Scene::default().chatter.resistance_threshold;
    let above: Vec<_> = rust.1.iter().map(|row| row[3] > threshold).collect();
    let long = above.split(|above| !above).filter(|stretch| stretch.len() > 3).count();
    assert!(rust.0.starts_with(&format!("interruptions of 5 us or more: {long}\n")) && long >= 2, "{}", rust.0);
    assert!(!rust.0.contains("steps done again: 0"), "{}", rust.0);
}

#[test]
fn a_small_vibration_gives_the_linear_response() {
    let mut scene = Scene::default();
    scene.contact.overtravel = 0.19e-3;
    let (amplitude, model) = (0.5, Model::new(&scene, 0.0).unwrap());
    let (_, rows) = run(in_rust(), "0.5", "0.015", "embed-small.csv");
    // A sin(950 Hz) sin(50 Hz) is half of cos(900 Hz) less half of cos(1000 Hz).
    let responses = [(900.0, 0.5), (1000.0, -0.5)].map(|(frequency, part)| {
        let omega = TAU * frequency;
        (omega, reference::response(&model, omega) * part)
    });
    let force = |time: f64| {
        let turned = responses.map(|(omega, force)| (force * Complex::new(0.0, omega * time).exp()).re);
        model.preload.force + amplitude * (turned[0] + turned[1])
    };
    let scale = amplitude * responses[0].1.norm().max(responses[1].1.norm()) * 2.0;
    // What rings from the start has gone after 10 ms: the damping of the first mode is some 3000 1/s. The law of the
    // contact departs from its tangent by about the amplitude over the preload, here 0.2 %. An acceleration held over
    // the steps would come half a step late, 0.6 % of the amplitude.
    assert!(scale < 2e-3 * model.preload.force);
    let off = rows[5000..].iter().map(|row| (row[2] - force(row[0])).abs()).fold(0.0, worst);
    assert!(off < 2e-3 * scale, "{off} N of {scale} N");
}

#[test]
fn a_refused_value_ends_an_example_with_its_name_and_range() {
    for (acceleration, duration, told) in [
        ("nan", "0.01", "base.acceleration = NaN m/s2: not allowed"),
        ("40o", "0.01", "40o: not a number"),
        // Not a run without interruptions.
        ("400", "nan", " s: not allowed, allowed is a positive number"),
        ("400", "-0.01", "-0.01 s: not allowed, allowed is a positive number"),
        ("400", "inf", "inf s: not allowed, allowed is a positive number"),
    ] {
        for mut program in [in_rust(), in_c()] {
            let table = Path::new(env!("CARGO_TARGET_TMPDIR")).join("refused.csv");
            let ran = program.args([acceleration, duration]).arg(table).output().unwrap();
            let said = String::from_utf8_lossy(&ran.stderr);
            assert!(!ran.status.success() && said.contains(told), "{said}");
        }
    }
}

#[test]
fn the_header_names_every_variable() {
    let lines: Vec<_> = relay_contact::C_HEADER.lines().collect();
    for variable in &VARIABLES {
        let described = |line: &&str| line.contains(&format!("* `{}`, ", variable.name));
        let at = lines.iter().position(described).unwrap_or_else(|| panic!("{}", variable.name));
        let constant: String = variable.name.chars().filter(|c| *c != '.').collect();
        let defined: Vec<_> = lines[at + 2].split(' ').collect();
        let name = defined[1].strip_prefix("RELAY_CONTACT_").unwrap().replace('_', "");
        assert_eq!(name, constant.to_uppercase());
        assert_eq!(defined[2], format!("{}u", variable.value_reference));
    }
}
