//! Who is answered. A server on the loopback address is in reach of every page in the user's
//! browser and of every other user of the machine:
//!
//! - a page elsewhere whose name is made to point here (DNS rebinding) still says its own name: `Host`;
//! - a page elsewhere that calls this address says where it comes from: `Origin`, `Sec-Fetch-Site`;
//! - another user of the machine says neither, but does not know the token.

use axum::http::header::{HOST, HeaderMap, ORIGIN};
use axum::http::{Method, Request, StatusCode};
use subtle::ConstantTimeEq;

use crate::exit::{Exit, Failure};

/// Decides over requests.
pub(super) struct Gate {
    hosts: Vec<String>,
    token: String,
}

/// A new token, 128 bits at random.
///
/// # Errors
/// A system without random numbers.
pub(super) fn token() -> Result<String, Failure> {
    let mut bits = [0; 16];
    getrandom::fill(&mut bits).map_err(|error| {
        Failure::new(Exit::Ours, format!("no random numbers for the preview's token: {error}"))
    })?;
    Ok(format!("{:032x}", u128::from_be_bytes(bits)))
}

impl Gate {
    /// A gate that wants this token.
    ///
    /// # Errors
    /// A host that is no name.
    pub(super) fn new(port: u16, token: String, allowed: &[String]) -> Result<Self, Failure> {
        let mut hosts = vec![format!("127.0.0.1:{port}"), format!("localhost:{port}")];
        for host in allowed {
            let legal = |c: char| c.is_ascii_alphanumeric() || ".-:[]".contains(c);
            if host.is_empty() || !host.chars().all(legal) {
                let message = format!("`{host}` is not the name of a host");
                return Err(Failure::new(Exit::Usage, message)
                    .help("as in --allow-host box.example or --allow-host box.example:8080"));
            }
            hosts.push(host.to_ascii_lowercase());
        }
        Ok(Self { hosts, token })
    }

    pub(super) fn token(&self) -> &str {
        &self.token
    }

    /// The host that was asked for, if the request may be answered; else what to answer with.
    pub(super) fn check<B>(&self, request: &Request<B>) -> Result<String, StatusCode> {
        let host = one(request.headers(), HOST.as_str()).ok_or(StatusCode::MISDIRECTED_REQUEST)?;
        let host = host.to_ascii_lowercase();
        if !self.hosts.contains(&host) {
            return Err(StatusCode::MISDIRECTED_REQUEST);
        }
        if is_foreign(request.headers(), &host) {
            return Err(StatusCode::FORBIDDEN);
        }
        if request.method() != Method::GET {
            return Err(StatusCode::METHOD_NOT_ALLOWED);
        }
        let query = request.uri().query().unwrap_or_default();
        let given = query.split('&').find_map(|pair| pair.strip_prefix("token="));
        let known = given.is_some_and(|given| given.as_bytes().ct_eq(self.token.as_bytes()).into());
        if known { Ok(host) } else { Err(StatusCode::FORBIDDEN) }
    }
}

/// Whether a page of another origin asks; one that merely leads here does not.
fn is_foreign(headers: &HeaderMap, host: &str) -> bool {
    let own = |origin: &str| {
        let name = origin.strip_prefix("http://").or_else(|| origin.strip_prefix("https://"));
        name.is_some_and(|name| name.eq_ignore_ascii_case(host))
    };
    if headers.contains_key(ORIGIN) {
        return !one(headers, ORIGIN.as_str()).is_some_and(own);
    }
    let site = one(headers, "sec-fetch-site").unwrap_or("none");
    let leads_here = one(headers, "sec-fetch-mode") == Some("navigate");
    !leads_here && !["none", "same-origin"].contains(&site)
}

/// The value of a header that stands there once.
fn one<'a>(headers: &'a HeaderMap, name: &str) -> Option<&'a str> {
    let mut values = headers.get_all(name).iter();
    let first = values.next()?.to_str().ok()?;
    values.next().is_none().then_some(first)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answer(gate: &Gate, query: &str, headers: &[(&str, &str)]) -> u16 {
        let mut request = Request::get(format!("/?{query}"));
        for (name, value) in headers {
            request = request.header(*name, *value);
        }
        gate.check(&request.body(()).unwrap()).map_or_else(|code| code.as_u16(), |_| 200)
    }

    fn gate(allowed: &[String]) -> Result<Gate, Failure> {
        Gate::new(7, token()?, allowed)
    }

    #[test]
    fn only_the_own_page_with_the_token_passes() {
        let gate = gate(&["Box.example".into()]).unwrap();
        let token = format!("token={}", gate.token);
        let host = ("host", "127.0.0.1:7");
        assert_eq!(answer(&gate, &token, &[host]), 200);
        assert_eq!(answer(&gate, &token, &[("host", "LOCALHOST:7")]), 200);
        assert_eq!(answer(&gate, &token, &[("host", "box.example")]), 200);
        assert_eq!(answer(&gate, &token, &[host, ("origin", "http://127.0.0.1:7")]), 200);
        assert_eq!(answer(&gate, &format!("x=1&{token}"), &[host]), 200);
        for wrong in ["127.0.0.1", "127.0.0.1:8", "evil.example:7", "127.0.0.1:7.evil", ""] {
            assert_eq!(answer(&gate, &token, &[("host", wrong)]), 421, "{wrong}");
        }
        assert_eq!(answer(&gate, &token, &[]), 421);
        assert_eq!(answer(&gate, &token, &[host, host]), 421);
        for wrong in ["null", "http://localhost:7", "http://127.0.0.1:8", "http://evil", ""] {
            assert_eq!(answer(&gate, &token, &[host, ("origin", wrong)]), 403, "{wrong}");
        }
        for wrong in ["", "token=", "token=0", "t=1", &token[..token.len() - 1]] {
            assert_eq!(answer(&gate, wrong, &[host]), 403, "{wrong}");
        }
        assert_eq!(answer(&gate, &format!("{token}0"), &[host]), 403);
    }

    #[test]
    fn a_foreign_page_may_lead_here_but_not_fetch() {
        let gate = gate(&[]).unwrap();
        let token = format!("token={}", gate.token);
        let ask = |site, mode| {
            let from =
                [("host", "127.0.0.1:7"), ("sec-fetch-site", site), ("sec-fetch-mode", mode)];
            answer(&gate, &token, &from)
        };
        assert_eq!(ask("cross-site", "navigate"), 200);
        assert_eq!(ask("same-origin", "cors"), 200);
        assert_eq!(ask("cross-site", "no-cors"), 403);
        assert_eq!(ask("same-site", "no-cors"), 403);
    }

    #[test]
    fn two_tokens_differ_and_have_128_bits_and_names_are_checked() {
        let tokens = [token().unwrap(), token().unwrap()];
        assert!(tokens[0] != tokens[1]);
        assert!(tokens.iter().all(|token| token.len() == 32));
        for wrong in ["", "a b", "http://a/", "a;script-src *"] {
            assert!(gate(&[wrong.into()]).is_err(), "{wrong}");
        }
    }
}
