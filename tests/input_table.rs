//! Tables of inputs: what they hold is handed over at the communication points with its rate, and what is wrong in them is
//! said with the file, the line and the column.

use std::error::Error;
use std::fs;
use std::path::Path;

use relay_contact::error::SceneError;
use relay_contact::inputs::Inputs;
use relay_contact::scene::file::SceneFile;
use tempfile::TempDir;

const HEAD: &str = "stop = 1\ncommunicationStep = 1e-3\noutputs = []\n";

/// A folder that goes away.
struct Folder(TempDir);

impl Folder {
    fn new() -> Result<Self, Box<dyn Error>> {
        Ok(Self(tempfile::tempdir()?))
    }

    /// A scene with this table, and `rest` among its inputs.
    fn scene(&self, table: &str, rest: &str) -> Result<SceneFile, Box<dyn Error>> {
        fs::write(self.0.path().join("table.csv"), table)?;
        let path = self.0.path().join("scene.toml");
        fs::write(&path, format!("{HEAD}[inputs]\nfile = \"table.csv\"\n{rest}"))?;
        Ok(SceneFile::read(&path)?)
    }

    /// The message for such a scene, the paths of the files without their folder.
    fn message(&self, table: &str, rest: &str) -> String {
        let error = self
            .scene(table, rest)
            .map_or_else(|error| error.to_string(), |_| "accepted".to_owned());
        error.replace(&format!("{}{}", self.0.path().display(), std::path::MAIN_SEPARATOR), "")
    }
}

#[test]
fn between_rows_inputs_are_linear_and_beyond_them_held() -> Result<(), Box<dyn Error>> {
    let folder = Folder::new()?;
    let table = "time, contact.current ,support.displacement\n 0.25,0.5,0\n0.75,1.5,-1e-4\n";
    let file = folder.scene(table, "base.acceleration = 9\n")?;
    let held = |contact_current, support_displacement| Inputs {
        base_acceleration: 9.0,
        contact_current,
        support_displacement,
        ..Inputs::default()
    };
    assert_eq!(file.inputs_over(0.0, 0.125)?, held(0.5, 0.0));
    assert_eq!(file.inputs_over(0.75, 0.125)?, held(1.5, -1e-4));
    assert_eq!(file.inputs_over(2.0, 0.125)?, held(1.5, -1e-4));
    let half = file.inputs_over(0.5, 0.125)?;
    assert_eq!(half.contact_current, 1.0);
    assert_eq!(half.contact_current_rate, 2.0);
    assert_eq!(half.base_acceleration_rate, 0.0);
    assert!((half.support_displacement + 5e-5).abs() < 1e-19);
    assert!((half.support_displacement_rate + 2e-4).abs() < 1e-18);
    // Over a row the rate leads to the value at the end of the step.
    let over = file.inputs_over(0.5, 0.5)?;
    assert_eq!((over.contact_current, over.contact_current_rate), (1.0, 1.0));
    Ok(())
}

#[test]
fn a_value_set_by_name_holds_the_input() -> Result<(), Box<dyn Error>> {
    let folder = Folder::new()?;
    let mut file = folder.scene("time,contact.current\n0,0\n1,1\n", "")?;
    assert_eq!(file.inputs_over(0.5, 0.1)?.contact_current, 0.5);
    assert!(file.set("contact.current", "nan").is_err());
    assert_eq!(file.inputs_over(0.5, 0.1)?.contact_current, 0.5);
    file.set("contact.current", "3")?;
    let inputs = file.inputs_over(0.5, 0.1)?;
    assert_eq!((inputs.contact_current, inputs.contact_current_rate), (3.0, 0.0));
    Ok(())
}

#[test]
fn errors_in_a_table_are_reported_with_their_place() -> Result<(), Box<dyn Error>> {
    let folder = Folder::new()?;
    #[rustfmt::skip]
    let cases = [
        ("time,contact.curent\n0,1\n", ":1: contact.curent: no such input; similar: contact.current,"),
        ("time,contact.force\n0,1\n", ":1: contact.force: no such input; similar: contact.current,"),
        ("contact.current\n1\n", ":1: time: missing; expected a column of times in s"),
        ("time,contact.current,contact.current\n0,1,1\n", ":1: contact.current: given twice, allowed is one column"),
        ("time,contact.current\n0,1\n1,one\n", ":3: contact.current = \"one\": wrong type, allowed is a number"),
        ("time,contact.current\n0,1\n\n1,\n", ":4: contact.current = \"\": wrong type, allowed is a number"),
        ("time,support.displacement\n0,1\n", ":2: support.displacement = 1 m: not allowed, allowed is -0.1 to 0.1"),
        ("time,contact.current\n0,nan\n", ":2: contact.current = NaN A: not allowed, allowed is -1000000 to 1000000"),
        ("time,contact.current\n1,0\n1,1\n", ":3: time = 1 s: not allowed, allowed is any finite number above that of the previous row, 1 s"),
        ("time,contact.current\n0,1,2\n", ": not a table of inputs: CSV error: record 1 (line: 2, byte: 21): found record with 3 fields"),
        ("time,contact.current\n", ": not a table of inputs: no row below the header"),
    ];
    for (table, expected) in cases {
        let message = folder.message(table, "");
        let expected = format!("scene.toml:5: table.csv{expected}");
        assert!(message.starts_with(&expected), "{message}\n{expected}");
    }
    Ok(())
}

#[test]
fn a_missing_table_and_an_input_given_twice_are_reported() -> Result<(), Box<dyn Error>> {
    let folder = Folder::new()?;
    let twice = folder.message("time,contact.current\n0,1\n", "contact.current = 1\n");
    let expected = "scene.toml:6: contact.current: given twice, allowed is either a value here or a column of the file";
    assert_eq!(twice, expected);
    let missing = format!("{HEAD}[inputs]\nfile = \"no-such.csv\"\n").parse::<SceneFile>();
    let missing = missing.map_or_else(|error| error.to_string(), |_| "accepted".to_owned());
    assert!(
        missing.starts_with("line 5: no-such.csv: cannot be read: "),
        "{missing}"
    );
    let number = format!("{HEAD}[inputs]\nfile = 3\n").parse::<SceneFile>();
    let number = number.map_or_else(|error| error.to_string(), |_| "accepted".to_owned());
    assert_eq!(
        number,
        "line 5: file = 3: wrong type, allowed is the path of an input table, as a string"
    );
    assert!(matches!(
        SceneFile::read(Path::new("no-such.toml")),
        Err(SceneError::Unreadable { .. })
    ));
    Ok(())
}
