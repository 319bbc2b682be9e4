//! What was flown: said of a recording at any time, and found by.

use sqlx::{AssertSqlSafe, Row};

use super::maneuvers::{COLUMNS, ManeuverFilter, ManeuverRecord, read_record};
use super::page::one_more;
use super::search::words_of_maneuver;
use super::{BadCursor, Page, Project, StoreError};
use crate::flight::Flown;

impl Project {
    /// Changes the name of a maneuver, and what is said of it: `change` has the maneuver as it is, and answers with both as they
    /// shall be, or with why they stay. Changes at one time come one after the other. `None`: there is no such maneuver.
    ///
    /// # Errors
    /// The database cannot be written.
    pub async fn change_maneuver<E>(
        &self,
        id: &str,
        change: impl FnOnce(&ManeuverRecord) -> Result<(String, Flown), E>,
    ) -> Result<Option<Result<ManeuverRecord, E>>, StoreError> {
        let mut writing = self.store.begin().await?;
        // safe: put together from constants
        let sql = format!(
            "SELECT {COLUMNS} FROM maneuvers WHERE project = $1 AND id = $2 {}",
            self.store.engine.locking()
        );
        let row = sqlx::query(AssertSqlSafe(sql))
            .bind(&*self.name)
            .bind(id)
            .fetch_optional(writing.connection())
            .await?;
        let Some(row) = row else { return Ok(None) };
        let mut record = read_record(&row)?;
        match change(&record) {
            Ok((name, flown)) => (record.name, record.flown) = (name, flown),
            Err(why) => return Ok(Some(Err(why))),
        }
        let text =
            serde_json::to_string(&record.flown).map_err(|error| StoreError::Unwritable {
                what: "what was flown".into(),
                why: error.to_string(),
            })?;
        let sql =
            "UPDATE maneuvers SET name = $3, flown = $4, words = $5 WHERE project = $1 AND id = $2";
        sqlx::query(sql)
            .bind(&*self.name)
            .bind(id)
            .bind(&record.name)
            .bind(text)
            .bind(words_of_maneuver(&record.name, &record.flown))
            .execute(writing.connection())
            .await?;
        sqlx::query("DELETE FROM maneuver_marks WHERE project = $1 AND maneuver = $2")
            .bind(&*self.name)
            .bind(id)
            .execute(writing.connection())
            .await?;
        for (mark, value) in marks(&record.flown) {
            let sql = "INSERT INTO maneuver_marks (project, mark, value, maneuver) VALUES ($1, $2, $3, $4) ON CONFLICT DO NOTHING";
            sqlx::query(sql)
                .bind(&*self.name)
                .bind(mark)
                .bind(value)
                .bind(id)
                .execute(writing.connection())
                .await?;
        }
        writing.commit().await?;
        Ok(Some(Ok(record)))
    }

    /// Maneuvers that pass the filter, newest first.
    ///
    /// # Errors
    /// The database does not answer.
    pub async fn maneuvers(
        &self,
        filter: &ManeuverFilter,
        cursor: Option<&str>,
        limit: usize,
    ) -> Result<Result<Page<ManeuverRecord>, BadCursor>, StoreError> {
        const LATEST: &str = "9999-12-31T23:59:59.999Z";
        let (created, id) = match cursor.map(|cursor| cursor.split_once('~')) {
            None => (LATEST, ""),
            Some(Some(position)) => position,
            Some(None) => return Ok(Err(BadCursor)),
        };
        let wanted = [
            ("tag", &filter.tag),
            ("aircraft", &filter.aircraft),
            ("registration", &filter.registration),
            ("flight", &filter.flight),
            ("test_point", &filter.test_point),
        ];
        let wanted: Vec<(&str, &String)> = (wanted.into_iter())
            .filter_map(|(mark, value)| Some((mark, value.as_ref()?)))
            .collect();
        let mut sql = format!(
            "SELECT {COLUMNS} FROM maneuvers \
             WHERE project = $1 AND (created < $2 OR (created = $2 AND id < $3))"
        );
        for (number, (mark, _)) in wanted.iter().enumerate() {
            sql += &format!(
                " AND id IN (SELECT maneuver FROM maneuver_marks WHERE project = $1 AND mark = '{mark}' AND value = ${})",
                number + 5
            );
        }
        let words = filter.search.conditions("COALESCE(words, LOWER(name))");
        for (number, (condition, _)) in (wanted.len() + 5..).zip(&words) {
            sql += &format!(" AND {}", condition.replace('?', &format!("${number}")));
        }
        sql += " ORDER BY created DESC, id DESC LIMIT $4";
        // safe: put together from constants; what users wrote is bound
        let mut query = sqlx::query(AssertSqlSafe(sql))
            .bind(&*self.name)
            .bind(created)
            .bind(id)
            .bind(one_more(limit));
        for (_, value) in wanted {
            query = query.bind(value);
        }
        for (_, pattern) in words {
            query = query.bind(pattern);
        }
        let rows = query.fetch_all(&self.store.readers).await?;
        let cursor = |record: &ManeuverRecord| format!("{}~{}", record.created, record.id);
        Ok(Ok(Page::readable(&rows, limit, read_record, cursor)))
    }

    /// What was flown in recordings, in the order of `ids`; nothing of one that is not there.
    ///
    /// # Errors
    /// The database does not answer.
    pub async fn flown(&self, ids: &[&str]) -> Result<Vec<Option<Flown>>, StoreError> {
        let mut all = Vec::with_capacity(ids.len());
        for id in ids {
            let row = sqlx::query("SELECT flown FROM maneuvers WHERE project = $1 AND id = $2")
                .bind(&*self.name)
                .bind(*id)
                .fetch_optional(&self.store.readers)
                .await?;
            let Some(row) = row else {
                all.push(None);
                continue;
            };
            let flown = serde_json::from_str(row.try_get("flown")?)
                .map_err(|error| StoreError::corrupt(format!("maneuver {id}"), error))?;
            all.push(Some(flown));
        }
        Ok(all)
    }
}

/// Texts by which a recording is found, beside its tags.
const MARKS: [&str; 4] = ["aircraft", "registration", "flight", "test_point"];

/// By what a recording is found.
fn marks(flown: &Flown) -> Vec<(&'static str, &str)> {
    let texts = flown.texts().filter(|(name, _)| MARKS.contains(name));
    let tags = flown.tags.iter().map(|tag| ("tag", tag.as_str()));
    texts.chain(tags).collect()
}
