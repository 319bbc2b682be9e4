//! Models that users have stored.

use sqlx::any::AnyRow;
use sqlx::{AssertSqlSafe, Row};
use uuid::Uuid;

use super::page::one_more;
use super::row::read_id;
use super::search::{Search, words_of_model};
use super::{Page, Project, StoreError};
use crate::model::ModelDocument;

#[derive(Clone, PartialEq, Debug)]
pub struct ModelRecord {
    pub id: Uuid,
    pub created: String,
    pub document: ModelDocument,
}

fn read_model(row: &AnyRow) -> Result<ModelRecord, StoreError> {
    let id = read_id(row, "id")?;
    let document = serde_json::from_str(row.try_get("document")?)
        .map_err(|error| StoreError::corrupt(format!("model {id}"), error))?;
    Ok(ModelRecord {
        id,
        created: row.try_get("created")?,
        document,
    })
}

impl Project {
    /// Keeps a model that was checked. Kept again under the same id, it is what it was.
    ///
    /// # Errors
    /// The database cannot be written.
    pub async fn add_model(
        &self,
        id: Uuid,
        document: ModelDocument,
    ) -> Result<ModelRecord, StoreError> {
        let json = serde_json::to_string(&document).map_err(|error| StoreError::Unwritable {
            what: "the model".into(),
            why: error.to_string(),
        })?;
        let created = self.store.clock.now_text();
        let sql = "INSERT INTO models (project, id, name, title, created, document, words) VALUES ($1, $2, $3, $4, $5, $6, $7) \
             ON CONFLICT (id) DO NOTHING";
        sqlx::query(sql)
            .bind(&*self.name)
            .bind(id.to_string())
            .bind(&document.name)
            .bind(&document.title)
            .bind(&created)
            .bind(json)
            .bind(words_of_model(&document.name, &document.title))
            .execute(&self.store.writer)
            .await?;
        Ok(ModelRecord {
            id,
            created,
            document,
        })
    }

    /// # Errors
    /// The database does not answer.
    pub async fn model(&self, id: Uuid) -> Result<Option<ModelRecord>, StoreError> {
        let row =
            sqlx::query("SELECT id, created, document FROM models WHERE project = $1 AND id = $2")
                .bind(&*self.name)
                .bind(id.to_string())
                .fetch_optional(&self.store.readers)
                .await?;
        row.as_ref().map(read_model).transpose()
    }

    /// Deletes a model. Jobs that named it have it still: each keeps the document as it was. `false`: there is none.
    ///
    /// # Errors
    /// The database cannot be written.
    pub async fn delete_model(&self, id: Uuid) -> Result<bool, StoreError> {
        let deleted = sqlx::query("DELETE FROM models WHERE project = $1 AND id = $2")
            .bind(&*self.name)
            .bind(id.to_string())
            .execute(&self.store.writer)
            .await?;
        Ok(deleted.rows_affected() > 0)
    }

    /// Models that a search finds, newest first; `before` is the last one of the page before.
    ///
    /// # Errors
    /// The database does not answer.
    pub async fn models(
        &self,
        search: &Search,
        before: Option<Uuid>,
        limit: usize,
    ) -> Result<Page<ModelRecord>, StoreError> {
        let before = before.unwrap_or(Uuid::max()).to_string();
        let conditions = search.conditions("COALESCE(words, LOWER(name))");
        let mut sql =
            "SELECT id, created, document FROM models WHERE project = $1 AND id < $2".to_string();
        for (number, (condition, _)) in (4..).zip(&conditions) {
            sql += &format!(" AND {}", condition.replace('?', &format!("${number}")));
        }
        sql += " ORDER BY id DESC LIMIT $3";
        // safe: put together from constants; what users wrote is bound
        let mut query = sqlx::query(AssertSqlSafe(sql))
            .bind(&*self.name)
            .bind(before)
            .bind(one_more(limit));
        for (_, pattern) in conditions {
            query = query.bind(pattern);
        }
        let rows = query.fetch_all(&self.store.readers).await?;
        let cursor = |model: &ModelRecord| model.id.to_string();
        Ok(Page::readable(&rows, limit, read_model, cursor))
    }
}
