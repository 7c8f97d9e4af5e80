// What the server says of a reaction in fixed words, in the language of the page; other words stay as they are.

import { t } from "../../core/texts";

/** About which point a moment is. */
export function aboutIn(said: string): string {
  const [, joint, on] = /^the point of "(.+)" on "(.+)"$/.exec(said) ?? [];
  if (joint && on) return t('the point of "{joint}" on "{on}"', { joint, on });
  const [, body] = /^the centre of mass of "(.+)"$/.exec(said) ?? [];
  if (body) return t('the centre of mass of "{body}"', { body });
  if (said === "the world's origin") return t("the world's origin");
  return said;
}

/** Along which axes components are. */
export function frameIn(said: string): string {
  if (said === "world") return t("world");
  const [, body] = /^frame of "(.+)"$/.exec(said) ?? [];
  if (body) return t('frame of "{body}"', { body });
  const [, joint] = /^joint "(.+)", x along its axis$/.exec(said) ?? [];
  return joint ? t('joint "{joint}", x along its axis', { joint }) : said;
}

const GIVEN_UP: Record<string, () => string> = {
  "one of the moments across its axis": () => t("one of the moments across its axis"),
  "the force along its axis": () => t("the force along its axis"),
  "the force along its axis and the moments across it": () =>
    t("the force along its axis and the moments across it"),
  "the moment about its axis": () => t("the moment about its axis"),
  "the moment about one axis": () => t("the moment about one axis"),
  "the moment across its two axes": () => t("the moment across its two axes"),
  "the moments across its axis": () => t("the moments across its axis"),
  "the moments across its normal": () => t("the moments across its normal"),
};

/** What a joint of another kind would not hold any more. */
export const givenUp = (said: string): string => GIVEN_UP[said]?.() ?? said;
