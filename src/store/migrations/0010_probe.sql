-- Whether the database can be written is found out by writing: see store/readiness.rs.

CREATE TABLE probe (
    at TEXT NOT NULL
);
INSERT INTO probe (at) VALUES ('');
