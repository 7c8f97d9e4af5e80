import { afterEach, expect, test, vi } from "vitest";
import * as here from "../engine/here";
import { ApiError, api } from "./client";

vi.mock("../engine/here", () => ({
  canComputeHere: () => true,
  isHere: () => false,
  askHere: vi.fn(async () => ({ status: 201, text: '{"id":"here"}' })),
}));

afterEach(() => {
  vi.unstubAllGlobals();
  vi.useRealTimers();
});

/** A server that gives these answers, one after the other; the addresses that were asked. */
function answering(...answers: [number, unknown][]): string[] {
  const asked: string[] = [];
  vi.useFakeTimers();
  vi.stubGlobal("fetch", (path: string, request: { method: string }) => {
    asked.push(`${request.method} ${path}`);
    const [status, body] = answers[asked.length - 1] ?? [500, {}];
    const headers = { "content-type": "application/json" };
    return Promise.resolve(new Response(JSON.stringify(body), { status, headers }));
  });
  return asked;
}

async function submitted(waits: number[]) {
  const done = api.submit("screw", { student: "ada", answers: {} }, "a name", (before) => waits.push(before));
  const settled = done.catch((error: unknown) => error);
  await vi.runAllTimersAsync();
  return settled;
}

test("what is graded at once is told at once", async () => {
  const asked = answering([201, { id: "s" }]);
  expect(await submitted([])).toEqual({ id: "s" });
  expect(asked).toEqual(["POST /api/v1/lessons/screw/submissions"]);
});

test("what waits is asked for until it is graded, and its place is told", async () => {
  const waits: number[] = [];
  const asked = answering(
    [202, { id: "s", state: "waiting", before: 2 }],
    [200, { id: "s", state: "waiting", before: 0 }],
    [200, { id: "s", state: "graded", verdict: { id: "s", earned: 1 } }],
  );
  expect(await submitted(waits)).toEqual({ id: "s", earned: 1 });
  expect(waits).toEqual([2, 0]);
  expect(asked.slice(1)).toEqual(["GET /api/v1/submissions/s?wait=8", "GET /api/v1/submissions/s?wait=8"]);
});

test("what could not be graded is the server's fault", async () => {
  answering([202, { id: "s", state: "waiting", before: 0 }], [200, { id: "s", state: "failed" }]);
  const error = await submitted([]);
  expect(error instanceof ApiError && error.problem.code).toBe("not-graded");
});

const full = { code: "too-many-sessions", title: "Too many sessions", status: 503 };

test("what the server has no place for is computed in the page", async () => {
  const told = vi.fn();
  vi.stubGlobal("dispatchEvent", told);
  const asked = answering([503, full], [200, { scene: { bodies: [] } }]);
  const state = await api.createSession({ lesson: "screw" });
  expect(state).toEqual({ id: "here" });
  expect(asked).toEqual(["POST /api/v1/sessions", "GET /api/v1/lessons/screw"]);
  expect(here.askHere).toHaveBeenCalledWith("POST", "/sessions", { lesson: "screw", scene: { bodies: [] } });
  expect(told).toHaveBeenCalledOnce();
  // The next run does not ask for a place that there is not.
  answering([200, { scene: { bodies: [] } }]);
  await api.createSession({ lesson: "screw" });
  expect(here.askHere).toHaveBeenCalledTimes(2);
});

test("what is still asked of a run ends when the page leaves it", async () => {
  const asked: [string, AbortSignal | null][] = [];
  vi.stubGlobal("fetch", (path: string, request: { method: string; signal?: AbortSignal | null }) => {
    asked.push([`${request.method} ${path}`, request.signal ?? null]);
    return new Promise((_, refuse) =>
      request.signal?.addEventListener("abort", () => refuse(new DOMException("left", "AbortError"))),
    );
  });
  const of = (run: string) => `/api/v1/sessions/${run}`;
  const left = api.multipliers(of("a")).catch((error: unknown) => error);
  void api.jacobian(of("b"));
  vi.stubGlobal("fetch", async (path: string, request: { method: string }) =>
    asked.push([`${request.method} ${path}`, null]),
  );
  api.dropSession(of("a"));
  expect(await left).toBeInstanceOf(DOMException);
  expect(asked.map(([what, signal]) => [what, signal?.aborted])).toEqual([
    ["GET /api/v1/sessions/a/multipliers", true],
    ["GET /api/v1/sessions/b/jacobian", false],
    ["DELETE /api/v1/sessions/a", undefined],
  ]);
});

test("a policy is set in the place of the one that was read, and its own version is learnt", async () => {
  const asked: string[] = [];
  vi.stubGlobal("fetch", (path: string, request: { method: string }) => {
    asked.push(`${request.method} ${path}`);
    return Promise.resolve(new Response(null, { status: 204, headers: { etag: '"new"' } }));
  });
  expect(await api.setPolicy("screw", { most_attempts: 3 }, "old")).toBe("new");
  expect(asked).toEqual(["PUT /api/v1/assignments/screw?version=old"]);
  answering([409, { code: "policy-changed", title: "Policy changed", status: 409 }]);
  const error: unknown = await api.setPolicy("screw", {}, "old").catch((error: unknown) => error);
  expect(error instanceof ApiError && error.problem.code).toBe("policy-changed");
});
