// How to join a lecture, over the whole screen.

import { addressOf } from "../core/address";
import { h } from "../core/dom";
import { parts, t } from "../core/texts";
import { dialog } from "../ui/dialog";

/** Shows the code of a lecture. */
export const invite = (room: string): Promise<void> =>
  inviteTo(t("Join this lecture"), { typed: "/room", linked: `/room/${room}`, code: room });

/** Shows a code in type that is read from the back of a lecture hall, and the address with it as a picture for phones. */
export async function inviteTo(
  title: string,
  { typed, linked, code }: { typed: string; linked: string; code: string },
): Promise<void> {
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
        h("p", { class: "invite-code" }, code),
        here
          ? h(
              "p",
              { class: "notice is-note" },
              t(
                "This address is known to this computer only. For a class start the server with “triad serve --class --host 0.0.0.0” and open the page at this computer’s address in the network.",
              ),
            )
          : null,
      ),
    ),
  );
  box.classList.add("is-wide");
}
