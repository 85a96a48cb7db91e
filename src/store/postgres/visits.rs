//! The visits and the owner's password in `PostgreSQL`.

use super::{Postgres, name, whole};
use crate::store::{StoreError, Visit, Visitor, Visits};

impl Visits for Postgres {
    fn password(&self) -> Result<Option<String>, StoreError> {
        let rows = self.rows("SELECT password FROM owner", &[])?;
        Ok(rows.first().map(|row| row.get(0)))
    }

    fn set_password(&self, hash: Option<&str>) -> Result<(), StoreError> {
        // One statement, so that it is both or nothing.
        self.rows(
            "WITH ended AS (DELETE FROM visits),
                  removed AS (DELETE FROM owner WHERE $1::text IS NULL)
             INSERT INTO owner (one, password) SELECT 1, $1::text WHERE $1::text IS NOT NULL
             ON CONFLICT (one) DO UPDATE SET password = excluded.password",
            &[&hash],
        )?;
        Ok(())
    }

    fn begin_visit(&self, digest: &str, invite: Option<&str>, now: u64) -> Result<(), StoreError> {
        // What is asked again after a broken connection may have happened.
        self.rows(
            "INSERT INTO visits (digest, invite, begun, seen) VALUES ($1, $2, $3, $3)
             ON CONFLICT DO NOTHING",
            &[&digest, &invite, &now.cast_signed()],
        )?;
        Ok(())
    }

    fn visit(&self, digest: &str) -> Result<Option<Visit>, StoreError> {
        let rows = self.rows(
            "SELECT invites.session, visits.begun, visits.seen, visits.invite, invites.person
             FROM visits LEFT JOIN invites ON invites.digest = visits.invite
             WHERE visits.digest = $1 AND (visits.invite IS NULL OR invites.digest IS NOT NULL)",
            &[&digest],
        )?;
        let Some(row) = rows.first() else {
            return Ok(None);
        };
        let visitor = match row.get(3) {
            None => Visitor::Owner,
            Some(invite) => Visitor::Invited {
                invite,
                session: name(row, 0)?,
                person: whole(row, 4) as u32,
            },
        };
        Ok(Some(Visit {
            visitor,
            begun: whole(row, 1),
            seen: whole(row, 2),
        }))
    }

    fn see_visit(&self, digest: &str, now: u64) -> Result<(), StoreError> {
        let sql = "UPDATE visits SET seen = greatest(seen, $2) WHERE digest = $1";
        self.rows(sql, &[&digest, &now.cast_signed()])?;
        Ok(())
    }

    fn end_visit(&self, digest: &str) -> Result<(), StoreError> {
        self.rows("DELETE FROM visits WHERE digest = $1", &[&digest])?;
        Ok(())
    }

    fn forget_visits(&self, before: u64) -> Result<(), StoreError> {
        let sql = "DELETE FROM visits WHERE begun < $1";
        self.rows(sql, &[&before.cast_signed()])?;
        Ok(())
    }
}
