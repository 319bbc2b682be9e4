//! Requests that may be sent twice and are to be done once: what was answered is kept under the client's key.

use std::time::Duration;

use serde::{Deserialize, Serialize};
use sqlx::{AssertSqlSafe, Row};
use uuid::Uuid;

use super::row::read_id;
use super::{Project, StoreError};

/// How long a request stays with whoever took it in hand; then it is thought to have died with its process.
const IN_HAND: Duration = Duration::from_secs(30);

/// How long an answer is kept.
const KEPT: Duration = Duration::from_secs(24 * 3600);

/// An answer as it is kept.
#[derive(Clone, PartialEq, Eq, Debug, Serialize, Deserialize)]
pub struct KeptAnswer {
    pub status: u16,
    /// Names and values of the headers that matter.
    pub headers: Vec<(String, String)>,
    #[serde(skip)]
    pub body: Vec<u8>,
}

/// What to do with a request that has a key.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Once {
    /// It is the first, or the one before it died: do it. What it makes gets this id, so that it is made once.
    Do(Uuid),
    /// It was done.
    Done(KeptAnswer),
    /// Its twin is in hand.
    InHand,
    /// The key was used for something else.
    Other,
}

impl Project {
    /// Takes a request in hand. `request` is a digest of what is asked for.
    ///
    /// # Errors
    /// The database cannot be written.
    pub async fn take_in_hand(&self, key: &str, request: &str) -> Result<Once, StoreError> {
        let (now, id) = (self.store.clock.now_text(), self.store.clock.new_id());
        let mut writing = self.store.begin().await?;
        sqlx::query("DELETE FROM answers WHERE until < $1 AND answer IS NOT NULL")
            .bind(&now)
            .execute(writing.connection())
            .await?;
        let sql = "INSERT INTO answers (submitter, key, request, resource, until) VALUES ($1, $2, $3, $4, $5) \
                   ON CONFLICT (submitter, key) DO NOTHING";
        let inserted = sqlx::query(sql)
            .bind(&*self.submitter)
            .bind(key)
            .bind(request)
            .bind(id.to_string())
            .bind(self.store.clock.text_after(IN_HAND))
            .execute(writing.connection())
            .await?;
        if inserted.rows_affected() > 0 {
            writing.commit().await?;
            return Ok(Once::Do(id));
        }
        let sql = format!(
            "SELECT request, resource, until, answer, body FROM answers WHERE submitter = $1 AND key = $2 {}",
            self.store.engine.locking()
        );
        let row = sqlx::query(AssertSqlSafe(sql))
            .bind(&*self.submitter)
            .bind(key)
            .fetch_optional(writing.connection())
            .await?;
        // let go of a moment ago: the next try finds the key free
        let Some(row) = row else {
            return Ok(Once::InHand);
        };
        if row.try_get::<&str, _>("request")? != request {
            return Ok(Once::Other);
        }
        if let Some(answer) = row.try_get::<Option<&str>, _>("answer")? {
            let answer: KeptAnswer = serde_json::from_str(answer)
                .map_err(|error| StoreError::corrupt("a kept answer", error))?;
            let body = row.try_get("body")?;
            return Ok(Once::Done(KeptAnswer { body, ..answer }));
        }
        if row.try_get::<&str, _>("until")? > now.as_str() {
            return Ok(Once::InHand);
        }
        sqlx::query("UPDATE answers SET until = $3 WHERE submitter = $1 AND key = $2")
            .bind(&*self.submitter)
            .bind(key)
            .bind(self.store.clock.text_after(IN_HAND))
            .execute(writing.connection())
            .await?;
        writing.commit().await?;
        Ok(Once::Do(read_id(&row, "resource")?))
    }

    /// Keeps the answer of a request that was in hand.
    ///
    /// # Errors
    /// The database cannot be written.
    pub async fn keep_answer(&self, key: &str, answer: &KeptAnswer) -> Result<(), StoreError> {
        let json = serde_json::to_string(answer).map_err(|error| StoreError::Unwritable {
            what: "an answer".into(),
            why: error.to_string(),
        })?;
        sqlx::query("UPDATE answers SET answer = $3, body = $4, until = $5 WHERE submitter = $1 AND key = $2")
            .bind(&*self.submitter)
            .bind(key)
            .bind(json)
            .bind(answer.body.as_slice())
            .bind(self.store.clock.text_after(KEPT))
            .execute(&self.store.writer)
            .await?;
        Ok(())
    }

    /// Lets go of a request that was refused or failed: under its key it may be tried anew, and put right.
    ///
    /// # Errors
    /// The database cannot be written.
    pub async fn let_go(&self, key: &str) -> Result<(), StoreError> {
        sqlx::query("DELETE FROM answers WHERE submitter = $1 AND key = $2 AND answer IS NULL")
            .bind(&*self.submitter)
            .bind(key)
            .execute(&self.store.writer)
            .await?;
        Ok(())
    }
}
