//! The life-cycle campaign: wrong and random calls to the component as from an importer, based on
//! `modelDescription.xml` and through the C functions only.
//!
//! ```text
//! texts        values of the string parameter
//! description  the variables and log categories, read from the XML
//! api          the 34 functions, of a loaded library or of the one linked here
//! call         one call as plain data; choices makes random ones
//! importer     makes a call on an instance and returns the result
//! states       the states, and which function is allowed in which
//! moment       the expected state of an instance at a time
//! life_cycle   the standard's state machine, independent of the component: expected status and state after a call
//! judge        makes a call and compares it with the life cycle
//! random       sequences of random calls; the shortest that still fails
//! hostile      saved states with manipulated contents and a correct checksum
//! ```
#![allow(clippy::undocumented_unsafe_blocks)] // every block calls a C function with valid arguments, or with wrong ones on purpose
#![allow(missing_docs, clippy::missing_errors_doc, clippy::missing_panics_doc)] // used only by tests
#![allow(clippy::wildcard_imports)] // of the standard's types and statuses
#![allow(non_upper_case_globals)] // the statuses in patterns are named as in the standard

pub mod api;
pub mod call;
pub mod choices;
pub mod description;
pub mod draw;
pub mod hostile;
pub mod importer;
pub mod judge;
pub mod life_cycle;
pub mod moment;
pub mod pointers;
pub mod random;
pub mod states;
pub mod texts;
