-- Who did what cannot be undone, or lets somebody in: see store/audit.rs.

CREATE TABLE audit (
    id      TEXT PRIMARY KEY NOT NULL, -- UUID v7: sorts by age
    project TEXT NOT NULL,             -- empty: all of them
    actor   TEXT NOT NULL,             -- the key, by its id; empty: who has the database at hand, or needs no key
    at      TEXT NOT NULL,
    deed    TEXT NOT NULL,
    subject TEXT NOT NULL
);
CREATE INDEX audit_of_project ON audit (project, id);
