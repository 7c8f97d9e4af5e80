import { describe, expect, it } from "vitest";
import { addressOf, inSite, pageIn, withoutBase } from "./address";

describe("an address in a site of files", () => {
  it("names the page in its query, beside what else is asked", () => {
    expect(inSite("/")).toBe("./");
    expect(inSite("/#lessons-title")).toBe("./#lessons-title");
    expect(inSite("/lessons/x?seen=abc#exercise")).toBe("./?page=/lessons/x&seen=abc#exercise");
  });

  it("leads to the files of the documentation", () => {
    expect(inSite("/docs/")).toBe("./docs/index.html");
    expect(inSite("/docs/scenes.html#joints")).toBe("./docs/scenes.html#joints");
  });

  it("leads back to its path, whatever stands in it", () => {
    for (const path of ["/", "/lessons/x", "/scenes/n-four-bar:2", "/scenes/a & b"]) {
      const url = new URL(inSite(encodeURI(path)), "http://host/some/course/");
      expect(url.pathname).toBe("/some/course/");
      expect(pageIn(url.search)).toBe(path);
    }
  });

  it("is known below the path of a server that stands at a part of another site", () => {
    expect(withoutBase("/triad/lessons/x", "/triad")).toBe("/lessons/x");
    expect(withoutBase("/triad", "/triad")).toBe("/");
    expect(withoutBase("/triads/x", "/triad")).toBe("/triads/x");
    expect(withoutBase("/lessons/x", "")).toBe("/lessons/x");
  });

  it("is the path itself where there is a server", () => {
    expect(addressOf("/lessons/x")).toBe("/lessons/x");
  });
});
