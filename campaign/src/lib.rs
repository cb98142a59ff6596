//! The life-cycle campaign: wrong and random calls to the component, made as an importer makes them, by what
//! `modelDescription.xml` says and through the C functions alone.
//!
//! ```text
//! description  the variables and log categories, read from the XML
//! api          the 34 functions, of a loaded library or of the one linked here
//! call         one call as plain data; choices makes random ones
//! importer     makes a call on an instance and gives what came back
//! states       the states, and which function is allowed in which
//! moment       what is true of an instance at a moment
//! life_cycle   the standard's state machine in our own words: which status a call must have, and what is true after it
//! judge        a call made, and compared with what the life cycle says
//! random       sequences of random calls; the shortest that still fails
//! hostile      saved states with damaged contents and a right checksum
//! ```
#![allow(clippy::undocumented_unsafe_blocks)] // every block calls a C function with what it needs, or, as the call says, without
#![allow(clippy::missing_panics_doc)] // tests are made of this
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
