//! One case: an aircraft, what is wrong with it and how strongly, flown and recorded.

use serde_json::json;
use trimtab_core::diagnose::Effect;
use trimtab_core::model::ModelDocument;

use crate::aircraft::{Aircraft, Kind};
use crate::fly::fly;
use crate::names::{renamed, reversed};
use crate::noise::{Colour, Noise};
use crate::plant::Plant;
use crate::random::Random;
use crate::record::{Recorder, Recording};
use crate::replay::Replay;

/// An aircraft of one seed with its noise; faults are put in by [`Setting::flown`].
pub(crate) struct Setting {
    pub aircraft: Aircraft,
    pub document: ModelDocument,
    /// By output.
    pub noises: Vec<Noise>,
    pub colour: Colour,
    pub seed: u64,
    /// Controls are recorded to a coarse digit.
    coarse: bool,
    names: Vec<(&'static str, &'static str)>,
}

/// Faults by number, with their sizes.
pub(crate) type Sized = Vec<(usize, f64)>;

impl Setting {
    /// `usual`: in the words of the catalog's models.
    pub(crate) fn new(
        kind: &Kind,
        seed: u64,
        colour: Colour,
        usual: bool,
        replay: Option<&Replay>,
    ) -> Self {
        let mut random = Random::new(seed, kind.name);
        let aircraft = (kind.make)(&mut random, replay);
        let names = if usual {
            kind.usual.to_vec()
        } else {
            Vec::new()
        };
        let text = renamed(&aircraft.document, &names);
        let document =
            toml::from_str(&text).unwrap_or_else(|error| panic!("{}: {error}", kind.name));
        let outputs = aircraft.channels.iter().filter(|c| c.output);
        let noises = outputs.map(|_| Noise::of(colour, &mut random)).collect();
        let coarse = random.chance(0.3);
        Self {
            coarse,
            aircraft,
            document,
            noises,
            colour,
            seed,
            names,
        }
    }

    /// A name or a term of the judge's in the words of the document.
    pub(crate) fn renamed(&self, text: &str) -> String {
        renamed(text, &self.names)
    }

    /// And the way back.
    pub(crate) fn own(&self, text: &str) -> String {
        renamed(text, &reversed(&self.names))
    }

    /// Target and term of an effect in the judge's words. The arm of a position is an axis, not a channel.
    pub(crate) fn place(&self, effect: &Effect) -> (String, Option<String>) {
        let is_arm = effect.word() == "sensor_position";
        let term = |term: &String| if is_arm { term.clone() } else { self.own(term) };
        (self.own(&effect.target), effect.term.as_ref().map(term))
    }

    /// What an effect is called, in the judge's words.
    pub(crate) fn called(&self, effect: &Effect) -> String {
        match self.place(effect) {
            (target, Some(term)) => format!("{} {term} in {target}", effect.word()),
            (target, None) => format!("{} {target}", effect.word()),
        }
    }

    /// Standard deviations of the outputs' noise, SI.
    pub(crate) fn deviations(&self) -> Vec<f64> {
        let outputs = self.aircraft.channels.iter().filter(|c| c.output);
        outputs.map(|c| c.noise * c.scale()).collect()
    }

    /// Options of an estimation with the noise given.
    pub(crate) fn known_noise(&self) -> serde_json::Value {
        let variance: Vec<f64> = self.deviations().iter().map(|d| d * d).collect();
        json!({"noise": {"kind": "given", "variance": variance}, "error_bounds": "conventional"})
    }

    /// The flights with these faults; `None` where one of them does not stay in the air. Without noise the flights of
    /// the fit alone.
    pub(crate) fn flown(&self, sized: &Sized, noisy: bool) -> Option<Vec<Recording>> {
        let aircraft = &self.aircraft;
        let mut recordings = Vec::new();
        for (number, sortie) in aircraft.sorties.iter().enumerate() {
            if !noisy && !sortie.fitted {
                continue;
            }
            let mut plant = Plant::default();
            for (fault, size) in sized {
                let mut random = Random::new(self.seed, &format!("fault {fault} flight {number}"));
                (aircraft.faults[*fault].install)(*size, number, &mut plant, &mut random);
            }
            let motions = fly(aircraft.frame.as_ref(), sortie, &plant, aircraft.sample)?;
            let recorder = Recorder {
                channels: &aircraft.channels,
                noises: &self.noises,
                noisy,
                coarse: self.coarse,
                sample: aircraft.sample,
            };
            let mut random = Random::new(self.seed, &format!("noise of flight {number}"));
            let names = &self.names;
            recordings.push(recorder.record(
                &sortie.label,
                sortie.fitted,
                &motions,
                &plant,
                names,
                &mut random,
            ));
        }
        Some(recordings)
    }
}
