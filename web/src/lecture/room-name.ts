// The name of a room that an instructor chooses once for a term: links and pictures on slides stay the same.

import { ApiError, api, problemOf } from "../api/client";
import { inClass } from "../api/identity";
import type { OpenedLecture } from "../api/types";
import { h } from "../core/dom";
import { recall, remember } from "../core/prefs";
import { t } from "../core/texts";
import { problemNotice } from "../ui/notice";

/** Fewest and most letters of a name; codes are shorter. */
const [SHORTEST, LONGEST] = [7, 40];

/** What was typed or linked, as codes and names are written: codes in capitals, names in small letters. */
export const writtenRoom = (typed: string): string => {
  const room = typed.trim();
  return room.length < SHORTEST ? room.toUpperCase() : room.toLowerCase();
};

/** The name that lectures of this browser are opened under; undefined: each has a code of its own. */
export const ownRoom = (): string | undefined => recall("room-name") ?? undefined;

/** What shows the server of a single person that a name is this browser's. */
function secret(): string {
  const kept = recall("room-secret");
  if (kept) return kept;
  const made = Array.from(crypto.getRandomValues(new Uint8Array(24)), (byte) =>
    byte.toString(16).padStart(2, "0"),
  ).join("");
  remember("room-secret", made);
  return made;
}

/** Opens a room for a run, under that name or under a new code; what was opened is what is opened next time. */
export async function openRoom(session: string, name: string | undefined): Promise<OpenedLecture> {
  const opened = await api.openLecture(session, name === undefined ? undefined : { name, secret: secret() });
  remember("room-name", name === undefined ? null : opened.code);
  return opened;
}

/** Opens a room as this browser does it; where its name is refused by now, the lecture begins all the same, and says why. */
export async function openOwnRoom(session: string): Promise<{ opened: OpenedLecture; refused?: unknown }> {
  const own = ownRoom();
  try {
    return { opened: await openRoom(session, own) };
  } catch (refused) {
    const ofName = refused instanceof ApiError && [409, 422].includes(refused.problem.status ?? 0);
    if (own === undefined || !ofName) throw refused;
    return { opened: await openRoom(session, undefined), refused };
  }
}

/** Why a name is refused; its place in the request is the field beside it. */
const notice = (error: unknown): HTMLElement => problemNotice({ ...problemOf(error), errors: [] });

/** A form that chooses the name; `use` opens the room under it, or under a code again. */
export function nameForm(
  room: string,
  use: (name: string | undefined) => Promise<void>,
  refused: unknown,
): HTMLElement {
  const input = h("input", {
    id: "room-name",
    class: "field",
    autocomplete: "off",
    autocapitalize: "none",
    spellcheck: "false",
    minlength: SHORTEST,
    maxlength: LONGEST,
    value: ownRoom() ?? "",
    required: true,
    "aria-describedby": "room-name-help",
  });
  const wrong = h("div", { "aria-live": "polite" }, refused ? notice(refused) : null);
  const attempt = (name: string | undefined): void => {
    wrong.replaceChildren();
    use(name).catch((error: unknown) => wrong.replaceChildren(notice(error)));
  };
  const form = h(
    "form",
    { class: "stack" },
    h("label", { for: "room-name" }, t("Name of the room")),
    h(
      "div",
      { class: "row wrap" },
      input,
      h("button", { class: "button" }, t("Use this name")),
      ownRoom() === room
        ? h(
            "button",
            { type: "button", class: "button quiet", onclick: () => attempt(undefined) },
            t("Use a code again"),
          )
        : null,
    ),
    wrong,
    h(
      "p",
      { class: "help", id: "room-name-help" },
      t(
        "7 to 40 letters a to z and digits, with hyphens between, such as mbs-2026. Each lecture that you open has this link from now on.",
      ),
      " ",
      inClass()
        ? t("The name belongs to your account: nobody else can open a lecture under it.")
        : t("The name belongs to this browser: no other can open a lecture under it."),
      " ",
      t("Whoever follows now has to join again."),
    ),
  );
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    attempt(writtenRoom(input.value));
  });
  return h(
    "details",
    { class: "expert", open: refused !== undefined },
    h("summary", null, t("A link that stays the same for the whole term")),
    form,
  );
}
