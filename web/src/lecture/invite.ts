// How to join a lecture, over the whole screen.

import { addressOf } from "../core/address";
import { h } from "../core/dom";
import { parts, t } from "../core/texts";
import { dialog } from "../ui/dialog";

/** Letters of a code that is shown as large as the window; names that were chosen are longer. */
const CODE = 8;

/** Shows the code of a lecture; `more` stands below it. */
export const invite = (room: string, more: HTMLElement): Promise<HTMLDialogElement> =>
  inviteTo(t("Join this lecture"), { typed: "/room", linked: `/room/${room}`, code: room }, more);

/** Shows a code in type that is read from the back of a lecture hall, and the address with it as a picture for phones. */
export async function inviteTo(
  title: string,
  { typed, linked, code }: { typed: string; linked: string; code: string },
  more?: HTMLElement,
): Promise<HTMLDialogElement> {
  const { qr } = await import("./qr");
  const address = new URL(addressOf(linked), location.href).href;
  const here = /^(localhost|127\.|\[::1\])/.test(location.hostname);
  const box = dialog(
    title,
    h(
      "div",
      { class: "invite" },
      qr(address),
      h(
        "div",
        { class: "stack" },
        h(
          "p",
          null,
          ...parts("Open {address} and type", {
            address: h("b", null, new URL(addressOf(typed), location.href).href.replace(/^https?:\/\//, "")),
          }),
        ),
        h("p", { class: code.length > CODE ? "invite-code is-name" : "invite-code" }, code),
        here
          ? h(
              "p",
              { class: "notice is-note" },
              t(
                "This address is known to this computer only. For a class start the server with “triad serve --class --host 0.0.0.0” and open the page at this computer’s address in the network.",
              ),
            )
          : null,
        more ?? null,
      ),
    ),
  );
  box.classList.add("is-wide");
  return box;
}
