//! Saved states with manipulated contents and a correct checksum, as by an attacker or a faulty transport that
//! computes checksums itself.

use relay_contact::fmi2::*;

use crate::api::Api;
use crate::call::{Call, Fault};
use crate::choices::Choices;
use crate::description::{DESCRIPTION, Kind};
use crate::importer::Importer;
use crate::judge::Judge;

/// Bytes before the contents: magic number, version, GUID, length.
pub fn head() -> usize {
    8 + 4 + DESCRIPTION.guid.len() + 8
}

/// Bytes after the contents: the checksum.
const TAIL: usize = 4;

/// Parameters of specimens, by type, name and value: each effect that loops in a way of its own.
pub const SPECIMENS: [&[(Kind, &str, f64)]; 8] = [
    &[],
    &[(Kind::String, "beam.file", 1.0)],
    &[(Kind::Integer, "effects.friction", 2.0)],
    &[(Kind::Integer, "effects.friction", 2.0), (Kind::Boolean, "effects.contactDamping", 0.0)],
    &[(Kind::Boolean, "effects.secondContact", 1.0), (Kind::Real, "second.gap", 1e-6)],
    &[(Kind::Integer, "effects.axialForce", 3.0), (Kind::Boolean, "effects.energy", 1.0)],
    &[(Kind::Integer, "effects.contactLaw", 3.0)],
    &[(Kind::Integer, "effects.excitation", 5.0), (Kind::Real, "beam.stiffnessDamping", 0.0)],
];

/// The serialized state of a contact under sine excitation that has opened.
pub fn specimen(api: &Api, parameters: &[(Kind, &str, f64)]) -> Vec<u8> {
    let parameters =
        parameters.iter().map(|&(kind, name, value)| Call::Set(kind, vec![(DESCRIPTION.reference(name), value)]));
    let [excitation, amplitude, enter, exit] = Call::shaken(400.0);
    let mut judge = Judge::new(api);
    let steps = [1e-3, 1.3e-6, 1.3e-6].map(Call::step);
    let bytes = [Call::GetState(0), Call::Serialize(0)];
    let calls: Vec<_> =
        [excitation, amplitude].into_iter().chain(parameters).chain([enter, exit]).chain(steps).chain(bytes).collect();
    judge.run(&calls).expect("the specimen runs");
    judge.importer.bytes(0).clone()
}

/// The bytes with length and checksum corrected for the contents.
pub fn repaired(mut bytes: Vec<u8>) -> Vec<u8> {
    if let Some(length) = bytes.len().checked_sub(head() + TAIL) {
        bytes[head() - 8..head()].copy_from_slice(&(length as u64).to_le_bytes());
        let end = bytes.len() - TAIL;
        let checksum = crc32fast::hash(&bytes[..end]).to_le_bytes();
        bytes[end..].copy_from_slice(&checksum);
    }
    bytes
}

/// Critical floating-point values.
const NUMBERS: [f64; 14] = [
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    0.0,
    -0.0,
    -1.0,
    1e308,
    -1e308,
    1e300,
    5e-324,
    1e-300,
    1e-12,
    1e9,
    1.0,
];

/// The serialized state with random changes, header and checksum correct.
pub fn changed(specimen: &[u8], choices: &mut Choices) -> Vec<u8> {
    let mut bytes = specimen.to_vec();
    for _ in 0..=choices.below(4) {
        let room = bytes.len() - head() - TAIL;
        let at = head() + choices.below(room);
        match choices.below(4) {
            // The contents are mostly numbers of eight bytes, one after the other.
            0 | 1 => {
                let number = choices.one(&NUMBERS).to_le_bytes();
                let end = (at + 8).min(head() + room);
                bytes[at..end].copy_from_slice(&number[..end - at]);
            }
            2 => bytes[at] = choices.below(256).to_le_bytes()[0],
            _ => bytes[at] ^= 1 << choices.below(8),
        }
    }
    repaired(bytes)
}

/// The outcome of manipulated bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Outcome {
    /// Rejected on deserialization.
    NotRead,
    /// Deserialized, but rejected by the instance.
    NotSet,
    /// Restored; a step failed.
    StepFailed,
    /// Restored, and all steps succeeded.
    WentOn,
}

/// Deserializes the bytes, restores the state, and makes `steps` communication steps.
/// An error is a panic in the component, recognised by its message, or a status that FMI does not allow.
pub fn meet(api: &Api, bytes: &[u8], steps: u32) -> Result<Outcome, String> {
    let mut importer = Importer::new(api);
    *importer.bytes(0) = bytes.to_vec();
    if answer(&mut importer, &Call::Deserialize(0), 0.0)?.0 != fmi2OK {
        return Ok(Outcome::NotRead);
    }
    if answer(&mut importer, &Call::SetState(0), 0.0)?.0 != fmi2OK {
        return Ok(Outcome::NotSet);
    }
    for step in 0..=steps {
        // Steps must start at the time of the instance.
        let (_, time) = answer(&mut importer, &Call::TIME, 0.0)?;
        let time = time.first().copied().unwrap_or(f64::NAN);
        for kind in [Kind::Real, Kind::Integer, Kind::Boolean] {
            answer(&mut importer, &Call::Get(kind, DESCRIPTION.outputs(kind)), time)?;
        }
        if step < steps && answer(&mut importer, &Call::step(1e-5), time)?.0 != fmi2OK {
            return Ok(Outcome::StepFailed);
        }
    }
    for call in [Call::GetState(1), Call::Serialize(1), Call::Reset] {
        if answer(&mut importer, &call, 0.0)?.0 != fmi2OK {
            return Err(format!("{call:?} is rejected"));
        }
    }
    Ok(Outcome::WentOn)
}

fn answer(importer: &mut Importer, call: &Call, time: f64) -> Result<(fmi2Status, Vec<f64>), String> {
    let answer = importer.make(call, Fault::None, time);
    let panics = |message: &&testing::log::Message| message.text.contains("internal error");
    if let Some(message) = importer.messages().iter().find(panics) {
        return Err(format!("{call:?}: {}", message.text));
    }
    if answer.0 > fmi2Error {
        return Err(format!("{call:?}: status {}", answer.0));
    }
    Ok(answer)
}
