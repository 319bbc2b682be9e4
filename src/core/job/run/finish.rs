//! The last step of every run: one list of findings, and whether the job puts up with it.

use crate::flight::{Fault, Faults, Finding, FindingCode};
use crate::job::plan::Plan;
use crate::job::result::JobResult;

/// Puts what was found before the run, in it, and by a diagnosis into one list.
///
/// # Errors
/// A finding that a strict job refuses.
pub(super) fn finish(plan: &Plan, mut result: JobResult) -> Result<JobResult, Faults> {
    let mut findings = plan.prepared.findings.clone();
    findings.append(&mut result.estimate.findings);
    findings.extend(
        result
            .estimate
            .prediction
            .iter()
            .filter(|p| p.outputs.is_empty())
            .map(|prediction| {
                let message = format!("it could not be predicted: {}", prediction.reason);
                let remedy =
                    "see whether its motion stays where the model holds; leave it out otherwise";
                Finding::new(FindingCode::NoPrediction, message, remedy)
                    .of_recording(&prediction.segment)
            }),
    );
    if let Some(diagnosis) = &result.diagnosis {
        let remark = |remark: &String| Finding::new(FindingCode::DiagnosisRemark, remark, "");
        findings.extend(diagnosis.remarks.iter().map(remark));
    }
    let refused: Vec<Fault> = plan.strict.faults(&findings);
    if !refused.is_empty() {
        return Err(refused.into());
    }
    result.estimate.findings = findings;
    Ok(result)
}
