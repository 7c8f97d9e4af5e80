// What the page's address asks to be shown, with a notice where it cannot be read.

import { t } from "../core/texts";
import { banner } from "../ui/notice";
import { type SharedView, viewOfAddress } from "./shared-view";

export async function requestedView(): Promise<SharedView | undefined> {
  const seen = await viewOfAddress();
  if (seen === undefined)
    banner(t("This link is damaged: the lesson or scene is shown from its start."), {
      label: t("Fine"),
      run: () => banner(null),
    });
  return seen ?? undefined;
}
