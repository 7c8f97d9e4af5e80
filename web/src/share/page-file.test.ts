import { expect, it } from "vitest";
import { PLACE } from "../player/played";
import { withMotion } from "./page-file";

it("nothing of the data ends the element that it stands in, and it reads back", () => {
  const motion = { title: "</script><script>alert(1)</script> $& $1" } as never;
  const page = withMotion(`<body>${PLACE}<script>play()</script>`, { motion });
  expect(page.match(/<script/g)).toHaveLength(2);
  const data = /id="motion">(.*?)<\/script>/s.exec(page)?.[1] ?? "";
  expect(JSON.parse(data)).toEqual({ motion });
  expect(() => withMotion("<body></body>", { motion })).toThrow();
});
