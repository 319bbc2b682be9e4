//! The one table of what can be found about data, a job and its result. The documentation prints it.

use super::severity::Severity;

macro_rules! codes {
    ($($(#[doc = $meaning:literal])+ $variant:ident $name:literal $severity:ident;)+) => {
        /// A stable word for what was found.
        #[derive(Clone, Copy, PartialEq, Eq, Debug)]
        pub enum FindingCode {
            $($(#[doc = $meaning])+ $variant,)+
        }

        impl FindingCode {
            /// All of them, in the order of the documentation: of files, of recordings, of jobs, of fits.
            pub const ALL: &'static [Self] = &[$(Self::$variant,)+];

            /// As it stands in `code`. It never changes its meaning.
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)+ }
            }

            /// How much it matters where nothing lessens it.
            pub fn severity(self) -> Severity {
                match self { $(Self::$variant => Severity::$severity,)+ }
            }

            /// What it means, for the documentation.
            pub fn meaning(self) -> &'static str {
                match self { $(Self::$variant => concat!($($meaning),+).trim_ascii(),)+ }
            }
        }
    };
}

codes! {
    /// A column of the file was left out, and why.
    LeftOut "left_out" Warning;
    /// A channel goes by another name than the file gives it.
    Renamed "renamed" Note;
    /// A column of the file has no unit: it was taken for a pure number.
    NoUnit "no_unit" Note;
    /// The layout of the file was recognised: which header, delimiter or mapping it was read with.
    Recognised "recognised" Note;
    /// A channel that a mapping knows is not in the file.
    Absent "absent" Note;
    /// The text is in another encoding than UTF-8, or has characters that are none.
    Encoding "encoding" Note;
    /// Zero bytes at the end of the file, as of a preallocated log, were passed over.
    ZeroBytes "zero_bytes" Note;
    /// Lines behind the table were passed over.
    Footer "footer" Note;
    /// The last line of the file is cut off: it was left out.
    IncompleteLine "incomplete_line" Note;
    /// The file ends before all samples that it announces: those that are there were read.
    CutOff "cut_off" Warning;
    /// The header stands in the file again: a logger was switched on a second time.
    RepeatedHeader "repeated_header" Note;
    /// Rows have the time of the row before them.
    RepeatedTime "repeated_time" Note;
    /// Messages of a log are not in the order of their times: those that do not fit were left out.
    OutOfOrder "out_of_order" Warning;
    /// A second column of the table has times, of fewer rows: channels that belong to it were read at those of the first.
    OtherTimes "other_times" Warning;
    /// Rows at the beginning have no time yet, and were left out.
    NoTimeYet "no_time_yet" Note;
    /// The recording stopped and started again.
    Gap "gap" Warning;
    /// Steps of time differ by more than the rounding of the time column explains.
    UnevenSampling "uneven_sampling" Warning;
    /// Time is told in ticks coarser than the sampling, such as whole milliseconds or 1/512 s; the sampling itself is even.
    CoarseClock "coarse_clock" Note;
    /// Samples are further apart than the motion of an aircraft allows, or closer than any recorder writes: the unit of time has slipped.
    ImplausibleRate "implausible_rate" Warning;
    /// Samples of a channel have no value.
    MissingValues "missing_values" Warning;
    /// One number, far from all others, stands in several samples: it may stand for "no value".
    Sentinel "sentinel" Warning;
    /// A channel is new in every n-th row only, and repeated in between: it was recorded at a lower rate and held, which makes it late and counts it several times.
    HeldChannel "held_channel" Warning;
    /// A channel that otherwise changes stands still for long: a stuck sensor, or a lost data link.
    RepeatedValues "repeated_values" Warning;
    /// Rows repeat the row before them, or earlier rows, in every channel that changes.
    RepeatedRows "repeated_rows" Warning;
    /// Single samples lie far from their neighbours.
    Spikes "spikes" Warning;
    /// An angle jumps by half a turn or a turn.
    Wrap "wrap" Warning;
    /// A channel has one value throughout.
    Constant "constant" Note;
    /// A quantity has a size that no aircraft flies: its unit has slipped.
    Implausible "implausible" Warning;
    /// Channels contradict each other: an angle is not the integral of its rate, a dynamic pressure not that of the speed, an acceleration not that of the attitude.
    ChannelsDisagree "channels_disagree" Warning;
    /// Two maneuvers of a job have the same samples: error bounds come out too small.
    RepeatedManeuver "repeated_maneuver" Warning;
    /// Two maneuvers of a job are rows of one recording, and some rows are in both.
    OverlappingRows "overlapping_rows" Warning;
    /// Parts of a recording begin in mid-motion, from an initial state that the model holds.
    HeldInitialState "held_initial_state" Warning;
    /// Constants of a catalog model were taken as they stand there: they are those of another aircraft.
    AssumedConstants "assumed_constants" Warning;
    /// A parameter is free in maneuvers only that the job does not have: it is zero in all.
    Elsewhere "elsewhere" Warning;
    /// Inputs that are held between samples explain the data far better than the straight lines that were assumed, or the reverse.
    InputInterpolation "input_interpolation" Warning;
    /// The model is not linear: an estimator of the frequency domain looks at small motions about the start of each maneuver.
    Linearised "linearised" Warning;
    /// An input has next to no power in the band of frequencies that is looked at.
    NoPowerInBand "no_power_in_band" Warning;
    /// The frequencies of a band tell few numbers for so many unknowns.
    FewFrequencies "few_frequencies" Warning;
    /// Terms of a structure determination are the same everywhere, or no numbers somewhere, and were left out.
    LeftOutTerms "left_out_terms" Warning;
    /// The data do not tell terms of a structure that were left out from those that were kept.
    CollinearTerms "collinear_terms" Warning;
    /// Terms of a structure are no larger than chance makes the largest of so many candidates: they may be noise.
    InsignificantTerms "insignificant_terms" Warning;
    /// Integration steps are too long for the accuracy of the estimate: with half their length a parameter would move.
    StepTooLong "step_too_long" Warning;
    /// A motion of the estimate is at the edge of what an integration step can follow.
    ModeAtEdge "mode_at_edge" Warning;
    /// With its start values the model grows so fast that no simulation follows the motion.
    UnstableModel "unstable_model" Warning;
    /// The solver stopped short of a minimum: the numbers are not an estimate, and their error bounds mean little.
    NotConverged "not_converged" Fault;
    /// A fit was poor beside what equation error reaches, and other starts were tried.
    SecondLook "second_look" Warning;
    /// A parameter is held at a bound.
    AtBound "at_bound" Note;
    /// The data cannot tell some parameters apart.
    RedundantParameters "redundant_parameters" Warning;
    /// The data cannot see some parameters.
    UnseenParameters "unseen_parameters" Warning;
    /// Some parameters are nearly collinear.
    NearlyCollinear "nearly_collinear" Note;
    /// An output is reproduced to rounding: error bounds would mean nothing and are left out.
    NoErrorBounds "no_error_bounds" Note;
    /// A maneuver that the model was not fitted to could not be predicted.
    NoPrediction "no_prediction" Warning;
    /// Something that a diagnosis remarks beside its verdict.
    DiagnosisRemark "diagnosis_remark" Note;
}

impl FindingCode {
    /// The code of this name.
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|code| code.name() == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_distinct_and_say_what_they_mean() {
        for (number, code) in FindingCode::ALL.iter().enumerate() {
            assert_eq!(FindingCode::find(code.name()), Some(*code));
            let before = &FindingCode::ALL[..number];
            assert!(before.iter().all(|other| other.name() != code.name()));
            assert!(code.meaning().ends_with('.'), "{}", code.meaning());
        }
        assert_eq!(FindingCode::find("no such code"), None);
    }
}
