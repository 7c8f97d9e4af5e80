import { expect, it } from "vitest";
import { wishOf } from "./wish";

it("an address in a frame is bounded: what is unknown is as if it were not there", () => {
  expect(wishOf("?forces=all&from=front&play=1&time=1.5&theme=dark")).toEqual({
    drawn: { what: "all" },
    camera: "front",
    plays: true,
    time: 1.5,
    theme: "dark",
  });
  expect(wishOf("?forces=<b>&from=below&play=yes&time=-1&theme=url(x)")).toEqual({
    drawn: { what: "none" },
    camera: "corner",
    plays: false,
    time: 0,
    theme: undefined,
  });
  expect(wishOf("?time=NaN").time).toBe(0);
});
