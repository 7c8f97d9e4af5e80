//! Settings of the sign-in with accounts of an institution.

use axum::http::StatusCode;
use clap::Args;

use crate::lti::address;
use crate::oidc::Provider;
use crate::problem::Problem;

#[derive(Debug, Args)]
#[allow(clippy::struct_field_names, reason = "names of the flags")]
pub(in crate::cli) struct Institution {
    /// Where an institution's sign-in says how it is asked (OpenID Connect), as https://login.school.example: who teaches may connect
    /// their account there and come back with it.
    #[arg(long, value_name = "URL", env = "TRIAD_OIDC_ISSUER")]
    pub(in crate::cli) oidc_issuer: Option<String>,
    /// What that sign-in calls this server.
    #[arg(long, value_name = "ID", env = "TRIAD_OIDC_CLIENT_ID")]
    pub(in crate::cli) oidc_client_id: Option<String>,
    /// The secret that it gave this server, if it did; others of the machine see a command line, but not the environment.
    #[arg(long, value_name = "SECRET", env = "TRIAD_OIDC_CLIENT_SECRET", hide_env_values = true)]
    pub(in crate::cli) oidc_client_secret: Option<String>,
    /// What people call it, for the button.
    #[arg(long, value_name = "NAME", env = "TRIAD_OIDC_NAME")]
    pub(in crate::cli) oidc_name: Option<String>,
}

impl Institution {
    /// The provider, if one is named. `reached`: whether browsers come back to the address of the class with what they were given.
    ///
    /// Errors if the settings contradict each other.
    pub(in crate::cli) fn provider(&self, reached: bool) -> Result<Option<Provider>, Problem> {
        let refused = |detail: &str, hint: &str| {
            Err(Problem::new(StatusCode::UNPROCESSABLE_ENTITY, "settings-contradict", detail, hint))
        };
        let (Some(issuer), Some(client_id)) = (&self.oidc_issuer, &self.oidc_client_id) else {
            let is_any = [&self.oidc_issuer, &self.oidc_client_id, &self.oidc_client_secret, &self.oidc_name];
            if is_any.iter().any(|one| one.is_some()) {
                return refused(
                    "oidc-issuer and oidc-client-id belong together",
                    "set both, or none that begins with oidc",
                );
            }
            return Ok(None);
        };
        if address::safe(issuer).is_none() {
            return refused("oidc-issuer is not encrypted", "write it as https://login.school.example");
        }
        if !reached {
            return refused(
                "oidc-issuer belongs to a class that browsers reach encrypted, or on this machine",
                "add --class, and its address with --url, as https://triad.example.org",
            );
        }
        Ok(Some(Provider {
            issuer: issuer.clone(),
            client_id: client_id.clone(),
            client_secret: self.oidc_client_secret.clone(),
            name: self.oidc_name.clone(),
        }))
    }
}
