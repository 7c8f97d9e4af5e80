// The header that stays: name, places, the student's name, theme, help.

import { api } from "../api/client";
import { inClass, me, roleWord, teaches } from "../api/identity";
import { addressOf, site } from "../core/address";
import { h } from "../core/dom";
import { bind, shortcuts } from "../core/keys";
import { student } from "../core/prefs";
import { LANGUAGES, type Language, language, parts, speak, t } from "../core/texts";
import { onTheme, projector, theme, toggleProjector, toggleTheme } from "../core/theme";
import mark from "../mark.svg?raw";
import { dialog } from "./dialog";
import { icon } from "./icons";
import { problemNotice } from "./notice";

export function header(root: HTMLElement): void {
  const brandMark = h("span", { class: "brand-mark", "aria-hidden": "true" });
  brandMark.innerHTML = mark;
  root.append(
    h(
      "a",
      { class: "brand", href: "/", "aria-label": t("Triad, all lessons") },
      brandMark,
      h("span", null, "Triad"),
    ),
    h(
      "nav",
      { "aria-label": t("Main") },
      h("a", { href: "/" }, t("Lessons")),
      h("a", { href: "/scenes" }, t("Scenes")),
      site ? null : h("a", { href: "/room" }, t("Join")),
      classLink(),
    ),
    h("span", { class: "header-space" }),
    nameButton(),
    projectorButton(),
    languageButton(),
    themeButton(),
    h(
      "button",
      {
        type: "button",
        class: "header-button square",
        "aria-label": t("Keyboard and help"),
        title: t("Keyboard and help (?)"),
        onclick: help,
      },
      icon("keys"),
    ),
  );
  bind([
    { keys: ["p", "P"], shown: "P", does: t("Projector: big type and strong lines"), run: toggleProjector },
    { keys: ["?"], shown: "?", does: t("Show this help"), run: help },
  ]);
}

/** The way to the class, for those who teach it. */
function classLink(): HTMLElement {
  const link = h("a", { href: "/class" }, t("Class"));
  const paint = (): void => {
    link.hidden = !teaches();
  };
  addEventListener("triad:student", paint);
  paint();
  return link;
}

function nameButton(): HTMLElement {
  const press = (): void => {
    if (!inClass()) askName();
    else if (me().person) account();
    else location.assign(addressOf("/join"));
  };
  const button = h("button", { type: "button", class: "header-button", id: "who", onclick: press });
  paintName(button);
  addEventListener("triad:student", () => paintName(button));
  return button;
}

/** The languages that the page does not speak now, each named in its own words. */
function others(): [Language, string][] {
  const all = Object.entries(LANGUAGES) as [Language, string][];
  return all.filter(([one]) => one !== language());
}

/** On narrow screens the choice stands in the help alone. */
function languageButton(): HTMLElement {
  return h(
    "span",
    { class: "wide-only" },
    ...others().map(([one, name]) =>
      h(
        "button",
        {
          type: "button",
          class: "header-button",
          lang: one,
          onclick: () => speak(one),
        },
        name,
      ),
    ),
  );
}

function projectorButton(): HTMLElement {
  const button = h(
    "button",
    {
      type: "button",
      class: "header-button square wide-only",
      "aria-label": t("Projector: big type and strong lines"),
      title: t("Projector: big type and strong lines (P)"),
      onclick: toggleProjector,
    },
    icon("projector"),
  );
  const paint = (): void => button.setAttribute("aria-pressed", String(projector()));
  onTheme(paint);
  paint();
  return button;
}

const otherTheme = (): string => (theme() === "dark" ? t("Use the light theme") : t("Use the dark theme"));

/** On the narrowest screens the choice stands in the help alone. */
function themeButton(): HTMLElement {
  const button = h("button", {
    type: "button",
    class: "header-button square theme-button",
    onclick: () => toggleTheme(),
  });
  const paint = (): void => {
    button.replaceChildren(icon(theme() === "dark" ? "sun" : "moon"));
    const label = otherTheme();
    button.setAttribute("aria-label", label);
    button.title = label;
  };
  onTheme(paint);
  paint();
  return button;
}

function paintName(button: HTMLButtonElement): void {
  const who = student.get();
  const nobody = inClass() ? t("Sign in") : t("Your name");
  const label = who ? `${who}, ${inClass() ? t("your account") : t("change the name")}` : nobody;
  // On narrow screens the picture stands for the words.
  button.replaceChildren(icon("person"), who ? h("span", { class: "who" }, who) : h("span", null, nobody));
  button.setAttribute("aria-label", label);
  button.title = label;
}

function account(): void {
  const { course, person } = me();
  const leave = h("button", { type: "button", class: "button" }, t("Sign out of this browser"));
  leave.addEventListener("click", () => void api.signOut().then(() => location.assign(addressOf("/"))));
  dialog(
    person?.name ?? "",
    h(
      "p",
      null,
      t("You are signed in as {role} of “{course}”.", {
        role: person ? roleWord(person.role) : "",
        course: course ?? "",
      }),
    ),
    h(
      "p",
      { class: "help" },
      t("To come back you need your four words, or the link that you kept with them."),
    ),
    ...ownAccount(),
    h("div", { class: "row" }, h("a", { class: "button", href: "/record" }, t("Your work")), leave),
  );
}

/** Connecting the account of an institution, for those who teach where the server knows one. */
function ownAccount(): HTMLElement[] {
  const { institution } = me();
  if (!institution || !teaches()) return [];
  const { name, connected } = institution;
  const wrong = h("div", { "aria-live": "polite" });
  const label = connected
    ? t("Disconnect this account")
    : name
      ? t("Connect {name}", { name })
      : t("Connect the account of your institution");
  const button = h("button", { type: "button", class: "button" }, label);
  const act = async (): Promise<void> => {
    if (!connected) return location.assign((await api.connectAccount()).to);
    await api.disconnectAccount();
    location.reload();
  };
  button.addEventListener("click", () => {
    button.disabled = true;
    act().catch((error: unknown) => {
      button.disabled = false;
      wrong.replaceChildren(problemNotice(error));
    });
  });
  const help = connected
    ? t("You also come back with the account of your institution.")
    : t("Then you also come back with that account. What you may do here stays as it is.");
  return [h("p", { class: "help" }, help), wrong, h("div", { class: "row" }, button)];
}

export function setStudent(name: string): void {
  if (name.trim() === student.get()) return;
  student.set(name);
  dispatchEvent(new Event("triad:student"));
}

function askName(): void {
  const input = h("input", {
    id: "name-input",
    class: "field",
    autocomplete: "name",
    maxlength: "80",
    value: student.get(),
  });
  const form = h(
    "form",
    { class: "stack" },
    h("label", { for: "name-input" }, t("Your name, as your instructor knows it")),
    input,
    h(
      "p",
      { class: "help" },
      t(
        "Your answers are stored under this name on the server that runs Triad, which asks for no proof: its grades are for yourself. This browser remembers the name.",
      ),
    ),
    h("div", { class: "row" }, h("button", { class: "button primary" }, t("Save"))),
  );
  const box = dialog(t("Who is working?"), form);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    setStudent(input.value);
    box.close();
  });
  input.select();
}

function help(): void {
  const rows = shortcuts
    .list()
    .map((entry) =>
      h(
        "tr",
        null,
        h("td", null, ...entry.shown.split(" ").map((key) => h("kbd", null, key))),
        h("td", null, entry.does),
      ),
    );
  const themes = h("button", { type: "button", class: "button small" }, otherTheme());
  themes.addEventListener("click", () => {
    toggleTheme();
    themes.textContent = otherTheme();
  });
  const toggle = h("input", { type: "checkbox", id: "keys-on" });
  toggle.checked = shortcuts.on();
  toggle.addEventListener("change", () => shortcuts.set(toggle.checked));
  dialog(
    t("Keyboard and help"),
    h(
      "p",
      null,
      t(
        "The keys act on the mechanism, wherever you are on the page, except while you type. They work without the 3-D view too: every number it shows stands in the tables below it.",
      ),
    ),
    h(
      "table",
      { class: "keys-table" },
      h(
        "thead",
        { class: "visually-hidden" },
        h("tr", null, h("th", { scope: "col" }, t("Key")), h("th", { scope: "col" }, t("What it does"))),
      ),
      h("tbody", null, ...rows),
    ),
    h(
      "p",
      { class: "row" },
      ...others().map(([one, name]) =>
        h("button", { type: "button", class: "button small", lang: one, onclick: () => speak(one) }, name),
      ),
      themes,
    ),
    h("p", { class: "check-line" }, toggle, h("label", { for: "keys-on" }, t("Single-key shortcuts"))),
    h(
      "p",
      { class: "help" },
      ...parts("Words, equations, scenes, Python: {documentation}.", {
        documentation: h("a", { href: "/docs/" }, t("the documentation")),
      }),
    ),
    h(
      "p",
      { class: "help" },
      t(
        "The lines between text, picture and inspector are dragged; with the keys, when one has the focus: the arrows, and Enter to put it back.",
      ),
    ),
    h(
      "p",
      { class: "help" },
      t(
        "In the drawing: drag beside the mechanism to look from elsewhere, drag a body to pull it, Ctrl and the wheel to come closer; with the keys, when it has the focus: Shift and the arrows, + and −.",
      ),
    ),
  );
}
