// What tells a robot's description from a scene.

/** Whether a text is markup, as a URDF is; a scene begins with a brace. */
export const isMarkup = (text: string): boolean => /^\uFEFF?\s*<[?!a-z]/i.test(text);

/** The line that a refusal of a URDF names, with its number: "line 17: joint elbow is of …". */
export function lineNamed(
  detail: string | undefined,
  text: string,
): { line: number; text: string } | undefined {
  const line = Number(/^line (\d+):/.exec(detail ?? "")?.[1] ?? Number.NaN);
  const found = text.split(/\r\n?|\n/)[line - 1]?.trim();
  return found ? { line, text: found } : undefined;
}
