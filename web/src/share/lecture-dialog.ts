// The lecture so far as a recording: it plays here, and goes into one file that plays anywhere.

import { h, saveFile, setText } from "../core/dom";
import { fileName } from "../core/format";
import { t } from "../core/texts";
import type { Taped } from "../lecture/tape";
import { LecturePlayer } from "../player/lecture-player";
import { dialog } from "../ui/dialog";
import { pageFile } from "./page-file";

export function lectureDialog(taped: Taped): void {
  const player = new LecturePlayer(taped);
  const said = h("p", { class: "help", role: "status" });
  const save = h("button", { type: "button", class: "button primary" }, t("Save the lecture (HTML)"));
  save.addEventListener("click", () => {
    pageFile({ lecture: taped })
      .then((blob) => {
        saveFile(blob, `${fileName(`${taped.title} ${taped.began.slice(0, 10)}`)}.html`);
        setText(said, t("Saved, {size} kB.", { size: Math.ceil(blob.size / 1000) }));
      })
      .catch(() => setText(said, t("The file could not be made: is the server still there?")));
  });
  const box = dialog(
    t("The lecture as a recording"),
    h(
      "p",
      null,
      t(
        "What was shown and asked, without sound; long pauses are shortened. The file needs no server and no network.",
      ),
    ),
    player.root,
    h("div", { class: "row wrap" }, save, said),
  );
  box.classList.add("is-wide");
  box.addEventListener("close", () => player.dispose());
}
