// Coming into a class: with its code, with an invitation, or back with four words or a link.

import { api } from "../api/client";
import { loadMe, me } from "../api/identity";
import type { Welcome } from "../api/types";
import { addressOf } from "../core/address";
import { h } from "../core/dom";
import { navigate, type Page } from "../core/router";
import { parts, t } from "../core/texts";
import { problemNotice } from "../ui/notice";

/** A field with its label. */
function field(
  id: string,
  label: string,
  more: Record<string, string | boolean> = {},
): {
  root: HTMLElement[];
  input: HTMLInputElement;
} {
  const input = h("input", { id, class: "field", required: true, maxlength: "100", ...more });
  return { root: [h("label", { for: id }, label), input], input };
}

/** A form that sends once, and shows what was wrong. */
function form(label: string, parts: HTMLElement[], send: () => Promise<void>): HTMLFormElement {
  const button = h("button", { class: "button primary" }, label);
  const wrong = h("div", { "aria-live": "polite" });
  const root = h("form", { class: "stack" }, ...parts, wrong, h("div", { class: "row" }, button));
  root.addEventListener("submit", (event) => {
    event.preventDefault();
    button.disabled = true;
    send()
      .catch((error: unknown) => wrong.replaceChildren(problemNotice(error)))
      .finally(() => {
        button.disabled = false;
      });
  });
  return root;
}

export function joinClassPage(outlet: HTMLElement, params: string[]): Page {
  const root = h("div", { class: "page narrow class-door" });
  outlet.append(root);
  const secret = location.hash.slice(1);
  if (me().mode === "home")
    root.append(
      h("h1", null, t("There is no class here")),
      h(
        "p",
        null,
        t("This server runs without accounts: its grades are for yourself."),
        " ",
        h("a", { href: "/" }, t("All lessons")),
      ),
    );
  else if (params[0] === "setup" && secret) setUp(root, secret);
  else if (params[0] === "return" && secret) returnByLink(root, secret);
  else join(root);
  return { title: t("Your class") };
}

function setUp(root: HTMLElement, token: string): void {
  const name = field("setup-name", t("Your name, as students see it"), { autocomplete: "name" });
  const title = field("setup-title", t("Title of the class"), { value: me().course ?? "" });
  root.append(
    h("h1", null, t("Welcome to your class")),
    form(t("Begin"), [...name.root, ...title.root], async () => {
      const body = { token, name: name.input.value, title: title.input.value };
      await welcome(root, await api.setUp(body), "/class", t("To the class"));
    }),
  );
  name.input.focus();
}

function returnByLink(root: HTMLElement, link: string): void {
  root.append(h("h1", null, t("Coming back…")));
  api
    .comeBack({ link })
    .then(loadMe)
    .then(() => navigate("/"))
    .catch((error: unknown) => root.append(problemNotice(error)));
}

function join(root: HTMLElement): void {
  const code = field("join-code", t("Code of the class"), {
    class: "field class-code",
    autocomplete: "off",
    spellcheck: "false",
    maxlength: "12",
    value: new URLSearchParams(location.search).get("code") ?? "",
  });
  const name = field("join-name", t("Your name, as your teacher knows it"), { autocomplete: "name" });
  const back = field("back-name", t("Your name"), { autocomplete: "name" });
  const words = field("back-words", t("Your four words"), { autocomplete: "off", spellcheck: "false" });
  root.append(
    h("h1", null, me().course ?? t("Your class")),
    me().join_open
      ? h(
          "section",
          null,
          h("h2", null, t("Here for the first time?")),
          form(t("Join the class"), [...code.root, ...name.root], async () => {
            const body = { code: code.input.value, name: name.input.value };
            await welcome(root, await api.join(body), "/", t("To the lessons"));
          }),
        )
      : h("p", null, t("Joining is closed at the moment: ask your teacher.")),
    h(
      "section",
      null,
      h("h2", null, t("You have joined before?")),
      form(t("Come back"), [...back.root, ...words.root], async () => {
        await api.comeBack({ name: back.input.value, words: words.input.value });
        await loadMe();
        navigate("/");
      }),
    ),
    ...withInstitution(),
  );
  (code.input.value ? name : code).input.focus();
}

/** The way in for those who teach and have connected the account of their institution. */
function withInstitution(): HTMLElement[] {
  const { institution } = me();
  if (!institution) return [];
  const { name } = institution;
  const label = name ? t("Sign in with {name}", { name }) : t("Sign in with the account of your institution");
  const button = h("button", { type: "button", class: "button" }, label);
  button.addEventListener("click", () => location.assign(addressOf("/oidc/login")));
  return [
    h(
      "section",
      null,
      h("h2", null, t("You teach here?")),
      h(
        "p",
        { class: "help" },
        t(
          "This works once you have connected that account: press your name at the top when you are signed in.",
        ),
      ),
      h("div", { class: "row" }, button),
    ),
  ];
}

/** What is told once: how to come back. */
async function welcome(root: HTMLElement, told: Welcome, then: string, label: string): Promise<void> {
  await loadMe();
  // The secret of an invitation is used up and need not stay in the address.
  history.replaceState(null, "", location.pathname);
  const link = `${location.origin}${addressOf("/return")}#${told.link}`;
  root.replaceChildren(
    h("h1", null, t("Welcome, {name}", { name: told.person.name })),
    h(
      "p",
      null,
      t(
        "This browser knows you from now on. On another device you come back with your name and these four words:",
      ),
    ),
    h("p", { class: "four-words" }, told.words),
    h(
      "p",
      null,
      ...parts(
        "Write them down now: they are not shown again. Or keep {link}, which opens your account at once.",
        {
          link: h("a", { href: link }, t("this link")),
        },
      ),
    ),
    h("p", null, h("a", { class: "button primary", href: then }, label)),
  );
}
