//! What people are in a course of the platform, and what that makes them here.

use crate::store::Role;

/// Roles in a course: LTI Core 1.3, A.2.3. Some platforms still send the short names of LTI 1.1.
const MEMBERSHIP: &str = "http://purl.imsglobal.org/vocab/lis/v2/membership";

/// What the person may do here. What they are elsewhere at the institution does not count, and nobody becomes an owner. Who
/// assists is named an instructor too, as the specification asks: the part counts.
pub fn role(roles: &[String]) -> Role {
    if roles.iter().any(|role| assists(role)) {
        Role::Grader
    } else if roles.iter().any(|role| teaches(role)) {
        Role::Instructor
    } else {
        Role::Student
    }
}

fn assists(role: &str) -> bool {
    let part = role.strip_prefix(MEMBERSHIP).and_then(|rest| rest.strip_prefix("/Instructor#"));
    part.is_some_and(|part| part.starts_with("TeachingAssistant") || part == "Grader")
}

fn teaches(role: &str) -> bool {
    let whole = role.strip_prefix(MEMBERSHIP).and_then(|rest| rest.strip_prefix('#')).unwrap_or(role);
    matches!(whole, "Instructor" | "Administrator" | "ContentDeveloper")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roles_of_the_course_count_and_no_others() {
        let of = |roles: &[&str]| role(&roles.iter().map(|role| (*role).to_owned()).collect::<Vec<_>>());
        let member = |role: &str| format!("{MEMBERSHIP}#{role}");
        assert_eq!(of(&[&member("Learner")]), Role::Student);
        assert_eq!(of(&[]), Role::Student);
        assert_eq!(of(&[&member("Instructor"), &member("Learner")]), Role::Instructor);
        assert_eq!(of(&["Instructor"]), Role::Instructor);
        let assistant = format!("{MEMBERSHIP}/Instructor#TeachingAssistant");
        assert_eq!(of(&[&member("Instructor"), &assistant]), Role::Grader);
        let elsewhere = "http://purl.imsglobal.org/vocab/lis/v2/institution/person#Instructor";
        assert_eq!(of(&[elsewhere, &member("Learner")]), Role::Student);
        assert_eq!(
            of(&["http://purl.imsglobal.org/vocab/lis/v2/system/person#Administrator"]),
            Role::Student
        );
        assert_eq!(of(&[&member("Mentor")]), Role::Student);
    }
}
