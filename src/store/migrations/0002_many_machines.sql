-- Many machines on one database: whoever writes a second time what it was not told had arrived writes it once, and jobs
-- wait in an order in which nobody has to wait behind all that another has submitted.

ALTER TABLE jobs ADD COLUMN written  BIGINT NOT NULL DEFAULT 0; -- events of the worker of this attempt
ALTER TABLE jobs ADD COLUMN priority BIGINT NOT NULL DEFAULT 0; -- larger goes first
ALTER TABLE jobs ADD COLUMN turn     BIGINT NOT NULL DEFAULT 0; -- among those of one priority, smaller goes first

CREATE INDEX jobs_in_order ON jobs (status, priority, turn, id);
