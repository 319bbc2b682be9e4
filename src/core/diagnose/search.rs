//! The search: forward, one effect a round, until no candidate passes; then by the ways that see what going forward alone
//! does not, and forward again where one of them led on.

use super::candidates;
use super::case::Case;
use super::declared::Declared;
use super::effect::Effect;
use super::exchange::exchange;
use super::fitted::Fitted;
use super::found::Found;
use super::report::RefusedEffect;
use super::round::{MOST_ROUNDS, Round, round};
use super::turbulence::{Disturbed, settle};
use super::two_at_once::two_at_once;
use super::unmodelled::{self, Picture};
use super::watch::{Stopped, Watcher, ask};

/// How often the declared model's fit may turn out to have ended in a false minimum.
const MOST_RENEWALS: usize = 2;

/// How often effects are exchanged in one diagnosis.
const MOST_EXCHANGES: usize = 3;

pub(super) struct Search<'c> {
    case: &'c Case,
    pub declared: Declared,
    /// The model that the rounds began with.
    pub start: Fitted,
    /// The model with all that was accepted.
    pub base: Fitted,
    pub found: Found,
    /// Of the last fit, where it was looked for: what no effect of the catalogue explains.
    pub picture: Option<Option<Picture>>,
    catalogue: Vec<Effect>,
    /// What the next round looks through.
    pool: Vec<Effect>,
    number: usize,
    exchanges: usize,
    /// The round in which no exchange paid.
    agreed: usize,
    has_tried_two: bool,
}

impl<'c> Search<'c> {
    /// From the declared model, which what was found so far has made `base` of.
    pub(super) fn new(case: &'c Case, declared: Declared, base: Fitted, found: Found) -> Self {
        let catalogue = candidates::candidates(case, &declared.fitted.problem.model);
        Self {
            case,
            declared,
            start: base.clone(),
            base,
            found,
            picture: None,
            pool: catalogue.clone(),
            catalogue,
            number: 1,
            exchanges: 0,
            agreed: 0,
            has_tried_two: false,
        }
    }

    /// Goes on until nothing more is found.
    ///
    /// # Errors
    /// The watcher stopped it.
    pub(super) fn run(&mut self, watcher: &mut Watcher<'_>) -> Result<(), Stopped> {
        while self.number <= self.last() {
            let left = self.left_of(&self.pool);
            let added = self.found.added();
            let round = round(self.case, &self.base, left, &added, self.number, watcher)?;
            let goes_on = match round.accepted.is_some() {
                true => self.take(round, watcher)?,
                false => self.look_again(round.refused, watcher)?,
            };
            if !goes_on {
                break;
            }
        }
        Ok(())
    }

    /// The last round: an exchange is a round, and adds no effect.
    fn last(&self) -> usize {
        MOST_ROUNDS + self.exchanges
    }

    /// Those that what was accepted has not ruled out.
    fn left_of(&self, pool: &[Effect]) -> Vec<Effect> {
        let is_left = |effect: &&Effect| {
            let mut accepted = self.found.accepted.iter();
            !accepted.any(|accepted| accepted.effect.rules_out(effect))
        };
        pool.iter().filter(is_left).cloned().collect()
    }

    /// Takes in what a round accepted; whether the search goes on.
    fn take(&mut self, round: Round, watcher: &mut Watcher<'_>) -> Result<bool, Stopped> {
        let Round {
            accepted: Some(accepted),
            refused,
            others,
            threshold,
        } = round
        else {
            return Ok(false);
        };
        self.begin_again();
        // what made the difference may be where the fit began, not the effect
        if self.found.accepted.is_empty()
            && !accepted.effect.is_noise()
            && self.declared.renewals() < MOST_RENEWALS
            && let Some(lower) = self.declared.lower(self.case, &accepted.fitted, watcher)
        {
            self.base = lower.fitted.clone();
            self.start = self.base.clone();
            self.declared = lower;
            return Ok(true);
        }
        self.found.refuse(refused);
        if accepted.effect.is_noise() {
            let disturbed = Disturbed {
                case: self.case,
                calm: &self.base,
                accepted,
                others,
                threshold,
                number: self.number,
            };
            self.base = settle(disturbed, &mut self.found, watcher)?;
            return Ok(false);
        }
        self.base = accepted.fitted.clone();
        self.found.accept(accepted, self.number, watcher)?;
        self.number += 1;
        Ok(true)
    }

    /// The next round looks through the catalogue.
    fn begin_again(&mut self) {
        self.picture = None;
        self.pool.clone_from(&self.catalogue);
    }

    /// Where no candidate passed: whether there is another way on.
    fn look_again(
        &mut self,
        refused: Vec<RefusedEffect>,
        watcher: &mut Watcher<'_>,
    ) -> Result<bool, Stopped> {
        self.found.refuse(refused.clone());
        Ok(self.find_two(&refused, watcher)?
            || self.exchange(watcher)?
            || self.look_beyond(watcher)?)
    }

    /// Two effects that hide each other, once in a search.
    fn find_two(
        &mut self,
        refused: &[RefusedEffect],
        watcher: &mut Watcher<'_>,
    ) -> Result<bool, Stopped> {
        let is_room_for_two = self.number < self.last();
        if !is_room_for_two || std::mem::replace(&mut self.has_tried_two, true) {
            return Ok(false);
        }
        let left = self.left_of(&self.catalogue);
        let (case, base, found) = (self.case, &self.base, &self.found);
        let two = two_at_once(case, base, found, refused, &left, self.number, watcher)?;
        let Some(two) = two else {
            return Ok(false);
        };
        for accepted in two {
            self.base = accepted.fitted.clone();
            self.found.accept(accepted, self.number, watcher)?;
            self.number += 1;
        }
        self.begin_again();
        Ok(true)
    }

    /// An effect in the place of one that stood for more than itself.
    fn exchange(&mut self, watcher: &mut Watcher<'_>) -> Result<bool, Stopped> {
        if self.exchanges == MOST_EXCHANGES || self.agreed == self.number {
            return Ok(false);
        }
        let (declared, base) = (&self.declared.fitted, &self.base);
        let (found, catalogue) = (&self.found, &self.catalogue);
        let exchanged = exchange(
            self.case,
            declared,
            base,
            found,
            catalogue,
            self.number,
            watcher,
        )?;
        let Some(exchanged) = exchanged else {
            self.agreed = self.number;
            return Ok(false);
        };
        self.exchanges += 1;
        self.base = exchanged.fitted.clone();
        exchanged.take_place(&self.declared.fitted, &mut self.found, self.number, watcher)?;
        self.number += 1;
        self.begin_again();
        Ok(true)
    }

    /// What the catalogue has no word for may still have a form.
    fn look_beyond(&mut self, watcher: &mut Watcher<'_>) -> Result<bool, Stopped> {
        if self.picture.is_some() {
            return Ok(false);
        }
        ask(watcher)?;
        let seen = unmodelled::found(self.case, &self.base);
        self.pool = (seen.as_ref()).map_or_else(Vec::new, |seen| seen.beyond(&self.catalogue));
        self.case.knowledge.apply(&mut self.pool);
        self.picture = Some(seen);
        Ok(!self.pool.is_empty())
    }
}
