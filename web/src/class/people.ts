// Everybody of the class: who may what, inviting those who grade or teach, other words, and erasing somebody's data.

import { api } from "../api/client";
import { me, roleWord } from "../api/identity";
import type { Somebody } from "../api/types";
import { addressOf } from "../core/address";
import { h } from "../core/dom";
import type { Page } from "../core/router";
import { t } from "../core/texts";
import { dialog } from "../ui/dialog";
import { problemNotice, skeleton } from "../ui/notice";
import { renewWords } from "./words";

const ROLES = {
  student: () => t("hands in, and sees what is their own"),
  grader: () => t("sees everybody’s work and decides about it"),
  instructor: () => t("runs the class: dates, regrades, codes"),
  owner: () => t("names the others, exports and erases"),
};
type Role = keyof typeof ROLES;

export function peoplePage(outlet: HTMLElement): Page {
  const place = h("div", null, skeleton(6));
  outlet.append(
    h(
      "div",
      { class: "page" },
      h("p", null, h("a", { href: "/class" }, t("← Class"))),
      h("header", { class: "page-head" }, h("h1", null, t("People"))),
      place,
    ),
  );
  const load = async (): Promise<void> => {
    try {
      const people = await api.people();
      place.replaceChildren(
        invitations(),
        table(people, () => void load()),
      );
    } catch (error) {
      place.replaceChildren(problemNotice(error, [{ label: t("Try again"), run: () => void load() }]));
    }
  };
  void load();
  return { title: t("People") };
}

const owns = (): boolean => me().person?.role === "owner";

function invitations(): HTMLElement {
  if (!owns())
    return h("p", { class: "help" }, t("Roles are given, and staff is invited, by an owner of the class."));
  const said = h("div", { "aria-live": "polite" });
  const role = h(
    "select",
    { id: "invite-role", class: "field" },
    ...(["grader", "instructor", "owner"] as const).map((word) =>
      h("option", { value: word }, `${roleWord(word)}: ${ROLES[word]()}`),
    ),
  );
  const form = h(
    "form",
    { class: "stack" },
    h("label", { for: "invite-role" }, t("Who comes with the link is")),
    role,
    said,
    h("div", { class: "row" }, h("button", { class: "button primary" }, t("Make a link"))),
  );
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    api
      .invite(role.value)
      .then(({ token }) =>
        said.replaceChildren(invitation(`${location.origin}${addressOf("/setup")}#${token}`, role.value)),
      )
      .catch((error: unknown) => said.replaceChildren(problemNotice(error)));
  });
  return h("section", null, h("h2", null, t("Invite somebody who grades or teaches")), form);
}

/** The link, to be sent; it is shown once. */
function invitation(link: string, role: string): HTMLElement {
  const field = h("input", {
    class: "field",
    readonly: true,
    value: link,
    "aria-label": t("Link for a new {role}", { role }),
  });
  field.addEventListener("focus", () => field.select());
  const copy = h("button", { type: "button", class: "button small" }, t("Copy"));
  copy.addEventListener("click", () => {
    field.select();
    navigator.clipboard
      ?.writeText(link)
      .then(() => copy.replaceChildren(t("Copied")))
      .catch(() => undefined);
  });
  return h(
    "div",
    { class: "stack" },
    h("div", { class: "row" }, field, copy),
    h(
      "p",
      { class: "help" },
      t("Good for one person and for a week. Send it to nobody else: it is not shown again."),
    ),
  );
}

function table(people: Somebody[], again: () => void): HTMLElement {
  const said = h("div", { "aria-live": "polite" });
  const rows = [...people]
    .sort((a, b) => rank(b.role) - rank(a.role))
    .map((one) =>
      h(
        "tr",
        null,
        h(
          "th",
          { scope: "row" },
          one.role === "student"
            ? h("a", { href: `/class/${encodeURIComponent(one.id)}` }, one.name)
            : one.name,
        ),
        h("td", null, owns() ? roleChoice(one, said, again) : roleWord(one.role)),
        h("td", null, h("div", { class: "row" }, ...actions(one, again))),
      ),
    );
  return h(
    "section",
    { class: "student-lesson" },
    h("h2", null, t("Everybody")),
    said,
    h(
      "div",
      { class: "table-scroll", tabindex: "0", role: "region", "aria-label": t("People and roles") },
      h(
        "table",
        { class: "data" },
        h(
          "thead",
          null,
          h(
            "tr",
            null,
            ...[t("Name"), t("Role"), t("Access")].map((text) => h("th", { scope: "col" }, text)),
          ),
        ),
        h("tbody", null, ...rows),
      ),
    ),
  );
}

const rank = (role: string): number => Object.keys(ROLES).indexOf(role);

function roleChoice(one: Somebody, said: HTMLElement, again: () => void): HTMLElement {
  const select = h(
    "select",
    { class: "field", "aria-label": t("Role of {name}", { name: one.name }) },
    ...Object.keys(ROLES).map((word) =>
      h("option", { value: word, selected: word === one.role }, roleWord(word)),
    ),
  );
  select.addEventListener("change", () => {
    const role = select.value as Role;
    if (rank(role) <= rank(one.role) && one.id !== me().person?.id) return change(one, role, said, again);
    // More rights, or fewer of one's own, are given on purpose.
    const sure = h(
      "button",
      { type: "button", class: "button primary" },
      t("Make {name} {role}", { name: one.name, role: roleWord(role) }),
    );
    const box = dialog(
      `${one.name}: ${roleWord(role)}`,
      h(
        "p",
        null,
        t("A person of this role {does}, and may do all that those below may.", { does: ROLES[role]() }),
      ),
      h("div", { class: "row" }, sure),
    );
    let chosen = false;
    box.addEventListener("close", () => {
      if (!chosen) again();
    });
    sure.addEventListener("click", () => {
      chosen = true;
      box.close();
      change(one, role, said, again);
    });
  });
  return select;
}

function change(one: Somebody, role: Role, said: HTMLElement, again: () => void): void {
  api
    .setRole(one.id, role)
    .then(() => {
      said.replaceChildren();
      again();
    })
    .catch((error: unknown) => {
      said.replaceChildren(problemNotice(error));
      again();
    });
}

function actions(one: Somebody, again: () => void): HTMLElement[] {
  if (one.id === me().person?.id || rank(one.role) > rank(me().person?.role ?? "student")) return [];
  if (rank(me().person?.role ?? "student") < rank("instructor")) return [];
  const words = h("button", { type: "button", class: "button small" }, t("New words"));
  words.setAttribute("aria-label", t("New words for {name}", { name: one.name }));
  words.addEventListener("click", () => renewWords(one.id, one.name));
  if (!owns()) return [words];
  const erase = h("button", { type: "button", class: "button small" }, t("Erase…"));
  erase.setAttribute("aria-label", t("Erase the data of {name}", { name: one.name }));
  erase.addEventListener("click", () => eraseDialog(one, again));
  return [words, erase];
}

function eraseDialog(one: Somebody, again: () => void): void {
  const reason = h("input", { id: "erase-reason", class: "field", required: true, maxlength: "2000" });
  const stay = h("input", { id: "erase-stay", type: "checkbox" });
  const wrong = h("div", { "aria-live": "polite" });
  const form = h(
    "form",
    { class: "stack" },
    h(
      "p",
      null,
      t(
        "Name, ways in and what was handed in are erased for good. Points, dates and decisions stay under a number; backups from before still have everything.",
      ),
    ),
    h("label", { for: "erase-reason" }, t("Who asked for it, or which rule says so (it stays in the log)")),
    reason,
    h("label", { class: "row", for: "erase-stay" }, stay, t("Keep the answers, without the name")),
    wrong,
    h("div", { class: "row" }, h("button", { class: "button primary" }, t("Erase for good"))),
  );
  const box = dialog(t("Erase the data of {name}", { name: one.name }), form);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    api
      .erase(one.id, { reason: reason.value, answers_stay: stay.checked })
      .then(() => {
        box.close();
        again();
      })
      .catch((error: unknown) => wrong.replaceChildren(problemNotice(error)));
  });
}
