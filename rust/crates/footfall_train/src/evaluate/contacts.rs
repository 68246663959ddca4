//! Contacts of people's feet, found in several ways, against each other.
//!
//! For motion, person by person: the contacts that the detector finds against those of Zeni et al. 2008, and the switches of hip and knee angles
//! against the detector's initial contacts. Of sensors on feet: switches, swings and the bodies that the sensor drives, against the events of a reference.

mod ablation;
mod agreement;
mod bodies;
mod error;
mod left_out;
mod people;
mod sensors;
mod switch_limits;

pub use ablation::Ablated;
pub use agreement::Agreement;
pub use error::ContactsError;
pub use people::{Limits, Person, mean_and_worst_f1};
pub use switch_limits::SwitchLimits;

use bodies::Bodies;
use footfall_motion::recording::Recording;
use footfall_motion::switches::SwitchConfig;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;

/// Request for an evaluation of contacts.
#[derive(Clone, Copy, Debug)]
pub struct ContactsRequest<'a> {
    /// Recordings of motion.
    pub recordings: &'a [Recording],
    /// Index of recordings of sensors on feet, with a column `events`.
    pub sensors: Option<&'a Path>,
    /// Model for one sensor on a foot, `.footimu`: the bodies that the sensors drive are judged as well.
    pub model: Option<&'a Path>,
    /// Largest difference at which switches, and events of sensors, count as the same as others, milliseconds.
    pub tolerance_ms: f64,
    /// True when the limits of both detectors are chosen on the other people for each person who is judged.
    pub leave_one_out: bool,
    /// True when switches are also judged without the parts that place them.
    pub ablate: bool,
}

impl Default for ContactsRequest<'_> {
    /// Nothing to judge, within two frames of 60 a second.
    fn default() -> Self {
        Self {
            recordings: &[],
            sensors: None,
            model: None,
            tolerance_ms: 33.4,
            leave_one_out: false,
            ablate: false,
        }
    }
}

/// Agreement of contacts; times in milliseconds.
#[derive(Clone, Debug, Serialize)]
pub struct ContactsReport {
    /// Tolerance of the request.
    pub tolerance_ms: f64,
    /// Results on motion, by person.
    pub people: BTreeMap<String, Person>,
    /// Switches of motion against contacts, by category.
    pub categories: BTreeMap<String, Agreement>,
    /// The same by what places a switch, where the request asks for it.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub ablation: BTreeMap<&'static str, Ablated>,
    /// Results on sensors, by category and kind of contact.
    pub sensors: BTreeMap<String, Agreement>,
}

/// Judges contacts of motion, of sensors, or of both.
///
/// # Errors
/// [`ContactsError`] names the file.
pub fn evaluate_contacts(request: &ContactsRequest<'_>) -> Result<ContactsReport, ContactsError> {
    let recordings = request.recordings;
    let tolerance_ms = request.tolerance_ms;
    let mut categories: BTreeMap<String, Agreement> = BTreeMap::new();
    for recording in recordings {
        let agreement = categories.entry(recording.row.category().to_owned());
        let agreement = agreement.or_default();
        agreement.add_switches(recording, &SwitchConfig::default(), tolerance_ms)?;
    }
    categories.values_mut().for_each(Agreement::summarise);
    Ok(ContactsReport {
        tolerance_ms,
        people: people::judge(recordings, tolerance_ms, request.leave_one_out)?,
        categories,
        ablation: if request.ablate {
            ablation::ablate(recordings, tolerance_ms)?
        } else {
            BTreeMap::new()
        },
        sensors: match request.sensors {
            Some(index) => {
                let bodies = request.model.map(Bodies::read).transpose()?;
                sensors::compare(index, bodies.as_ref(), tolerance_ms)?
            }
            None => BTreeMap::new(),
        },
    })
}
