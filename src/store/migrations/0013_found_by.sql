-- What jobs are about and how well they fit, for lists, and the words by which jobs, maneuvers and models are found: see
-- store/about.rs and store/search.rs. NULL in rows from before, which are filled in by the process that takes this step.

ALTER TABLE jobs ADD COLUMN about TEXT;      -- JSON
ALTER TABLE jobs ADD COLUMN fit TEXT;        -- JSON; NULL where there is no estimate
ALTER TABLE jobs ADD COLUMN words TEXT;      -- in lower case
ALTER TABLE maneuvers ADD COLUMN words TEXT;
ALTER TABLE models ADD COLUMN words TEXT;
