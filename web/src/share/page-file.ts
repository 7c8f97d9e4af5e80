// One HTML file with a recorded run: it plays without a server and without a network.

import { addressOf, fileOf, site } from "../core/address";
import { t } from "../core/texts";
import { PLACE, type Played } from "../player/played";

/** The player's own file, into which the motion is put; `triad run --html` does the same. */
const PLAYER = "/player.html";

/** The file's text, of the player's text and a motion. */
export function withMotion(player: string, played: Played): string {
  if (!player.includes(PLACE)) throw new Error(t("the player has no place for a motion"));
  // No letter of the data may end the element that it stands in.
  const data = JSON.stringify(played).replaceAll("<", "\\u003c");
  return player.replace(PLACE, () => PLACE.replace("></", () => `>${data}</`));
}

export async function pageFile(played: Played): Promise<Blob> {
  const response = await fetch(site ? fileOf(`.${PLAYER}`) : addressOf(PLAYER));
  if (!response.ok) throw new Error(t("the player cannot be loaded"));
  return new Blob([withMotion(await response.text(), played)], { type: "text/html" });
}
