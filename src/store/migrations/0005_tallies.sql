-- What is counted over all machines and kept when what was counted is gone: see store/tallies.rs.

CREATE TABLE tallies (
    name  TEXT NOT NULL,
    label TEXT NOT NULL,
    count BIGINT NOT NULL,
    sum   DOUBLE PRECISION NOT NULL,
    PRIMARY KEY (name, label)
);
