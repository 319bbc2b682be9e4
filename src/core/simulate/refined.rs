//! A segment with a sample at each integration step: all that steps along samples then takes several steps from one
//! recorded sample to the next, without knowing of it.

use super::block::Block;
use super::columns::Columns;
use super::method::InputInterpolation;
use super::pack::{Pack, packs};
use super::segment::{Segment, Steps, Substeps};
use super::stepper::between;
use crate::model::BLOCK;

/// A segment whose samples are integration steps.
pub(super) struct Refined {
    /// Nothing is measured in it.
    pub segment: Segment,
    /// By sample of the recorded segment: where it is.
    pub at: Vec<usize>,
}

impl Refined {
    /// `None` where there is one step a sample everywhere: the segment is its own refinement.
    pub(super) fn of(segment: &Segment, interpolation: InputInterpolation) -> Option<Self> {
        if segment.len() < 2 || segment.most_substeps() == 1 {
            return None;
        }
        let counts: Vec<usize> = (1..segment.len())
            .map(|k| segment.substeps.within(segment.steps.length(k - 1)))
            .collect();
        let sums = counts.iter().scan(0, |sum, count| {
            *sum += count;
            Some(*sum)
        });
        let at: Vec<usize> = std::iter::once(0).chain(sums).collect();
        let steps = match segment.steps {
            Steps::Even(step) => Steps::Even(step / counts[0] as f64),
            Steps::Uneven(_) => {
                let lengths = counts.iter().enumerate().flat_map(|(k, &count)| {
                    let length = segment.steps.length(k) / count as f64;
                    std::iter::repeat_n(length, count)
                });
                Steps::Uneven(lengths.collect())
            }
        };
        let refined = |samples: &Vec<f64>| -> Vec<f64> {
            let parts = counts.iter().enumerate().flat_map(|(k, &count)| {
                (0..count).map(move |part| {
                    let share = interpolation.share_of_next(part as f64 / count as f64);
                    between(samples[k], samples[k + 1], share)
                })
            });
            parts.chain(samples.last().copied()).collect()
        };
        let len = at.last().map_or(0, |last| last + 1);
        Some(Self {
            segment: Segment {
                label: String::new(),
                // who steps goes by the lengths of steps
                time: vec![0.0; len],
                steps,
                substeps: Substeps::Each(1),
                inputs: segment.inputs.iter().map(refined).collect(),
                measured: Vec::new(),
            },
            at,
        })
    }

    /// The recorded sample at a step, where there is one.
    pub(super) fn sample(&self, step: usize) -> Option<usize> {
        self.at.binary_search(&step).ok()
    }

    /// The recorded sample at a step, or the first behind it.
    pub(super) fn sample_from(&self, step: usize) -> usize {
        self.at.partition_point(|&at| at < step)
    }
}

/// Takes blocks of integration steps and hands on blocks of recorded samples.
pub(super) struct Thinning<'c> {
    columns: &'c Columns,
    /// By output: packs of a row.
    strides: Vec<usize>,
    outputs: Vec<[f64; BLOCK]>,
    rows: Vec<Vec<Pack>>,
    /// The first sample of the block that is being filled, and how many are in it.
    first: usize,
    len: usize,
}

impl<'c> Thinning<'c> {
    pub(super) fn new(columns: &'c Columns) -> Self {
        let strides: Vec<usize> = (0..columns.outputs())
            .map(|output| packs(columns.of_output(output).len()))
            .collect();
        Self {
            outputs: vec![[0.0; BLOCK]; strides.len()],
            rows: (strides.iter())
                .map(|stride| vec![Pack::default(); BLOCK * stride])
                .collect(),
            columns,
            strides,
            first: 0,
            len: 0,
        }
    }

    pub(super) fn pass(
        &mut self,
        refined: &Refined,
        block: &Block<'_>,
        mut sink: impl FnMut(&Block<'_>),
    ) {
        let next = self.first + self.len;
        let in_block = (refined.at[next..].iter()).take_while(|&&at| at < block.first + block.len);
        for &at in in_block {
            let (from, to) = (at - block.first, self.len);
            for (output, stride) in self.strides.iter().enumerate() {
                self.outputs[output][to] = block.output(output)[from];
                self.rows[output][to * stride..(to + 1) * stride].copy_from_slice(
                    &block.packed_rows(output)[from * stride..(from + 1) * stride],
                );
            }
            self.len += 1;
            if self.len == BLOCK || self.first + self.len == refined.at.len() {
                let rows: Vec<&[Pack]> = self.rows.iter().map(Vec::as_slice).collect();
                sink(&Block {
                    first: self.first,
                    len: self.len,
                    outputs: &self.outputs,
                    columns: self.columns,
                    rows: &rows,
                });
                self.first += self.len;
                self.len = 0;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn segment(steps: Steps, substeps: Substeps) -> Segment {
        Segment {
            label: String::new(),
            time: vec![0.0, 1.0, 3.0],
            steps,
            substeps,
            inputs: vec![vec![0.0, 6.0, 0.0]],
            measured: Vec::new(),
        }
    }

    #[test]
    fn steps_lie_evenly_between_samples_and_inputs_on_the_line_between_them() {
        let steps = Steps::Uneven(vec![1.0, 2.0]);
        let segment = segment(steps, Substeps::NoLonger(0.7));
        let fine = Refined::of(&segment, InputInterpolation::Linear).expect("several steps");
        assert_eq!(fine.at, [0, 2, 5]);
        let Steps::Uneven(steps) = &fine.segment.steps else {
            panic!("uneven")
        };
        let third = 2.0 / 3.0;
        assert_eq!(steps, &[0.5, 0.5, third, third, third]);
        let expected = [0.0, 3.0, 6.0, 4.0, 2.0, 0.0];
        for (found, expected) in fine.segment.inputs[0].iter().zip(expected) {
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
        assert_eq!((fine.sample(2), fine.sample(3)), (Some(1), None));
        assert_eq!((fine.sample_from(2), fine.sample_from(3)), (1, 2));
    }

    #[test]
    fn held_inputs_stay_held_and_one_step_is_the_segment_itself() {
        let fine = segment(Steps::Even(1.0), Substeps::Each(2));
        let fine = Refined::of(&fine, InputInterpolation::Hold).expect("two steps");
        assert_eq!(fine.segment.inputs[0], [0.0, 0.0, 6.0, 6.0, 0.0]);
        assert_eq!(fine.segment.steps, Steps::Even(0.5));
        // a step as long as a sample, but for rounding
        let one = segment(Steps::Even(0.1 + 0.2), Substeps::NoLonger(0.3));
        assert!(Refined::of(&one, InputInterpolation::Linear).is_none());
    }
}
