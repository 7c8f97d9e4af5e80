import { afterEach, expect, test, vi } from "vitest";
import { banner } from "../ui/notice";
import { Session } from "./session";

vi.mock("../core/dom", () => ({ announce: vi.fn() }));
vi.mock("../ui/notice", () => ({ banner: vi.fn() }));
vi.mock("../engine/here", () => ({ canComputeHere: () => false, isHere: () => false, askHere: vi.fn() }));

/** Streams that were opened; a test ends them as a server that goes would. */
const streams: Stream[] = [];

class Stream {
  onopen: (() => void) | undefined;
  onclose: (() => void) | undefined;
  onmessage: ((event: { data: string }) => void) | undefined;
  constructor(readonly url: string) {
    streams.push(this);
  }
  close(): void {}
}

afterEach(() => {
  vi.unstubAllGlobals();
  vi.useRealTimers();
  streams.length = 0;
});

function state(id: string, time: number): object {
  const self = `/api/v1/sessions/${id}`;
  return {
    id,
    title: "A pendulum",
    time,
    changes: 0,
    links: { self, stream: `${self}/stream` },
    finished: false,
    steps: 0,
    duration: 10,
    energy: 0,
    position_violation: 0,
    bodies: [],
  };
}

/** A server of which another one answers what was asked; the requests that it met, without those about what is drawn. */
function answering(answer: (request: string, body: unknown) => [number, unknown]): string[] {
  const asked: string[] = [];
  vi.stubGlobal("WebSocket", Stream);
  vi.stubGlobal("window", globalThis);
  vi.stubGlobal("addEventListener", vi.fn());
  vi.stubGlobal("location", { origin: "http://triad.test", href: "http://triad.test/" });
  vi.stubGlobal("fetch", (path: string, request: { method: string; body?: string }) => {
    const name = `${request.method} ${path}`;
    const body: unknown = request.body ? JSON.parse(request.body) : null;
    if (!/scene|drawing/.test(path)) asked.push(body ? `${name} ${JSON.stringify(body)}` : name);
    const [status, told] = answer(name, body);
    const headers = { "content-type": status < 400 ? "application/json" : "application/problem+json" };
    return Promise.resolve(new Response(JSON.stringify(told), { status, headers }));
  });
  return asked;
}

const GONE = {
  code: "node-gone",
  title: "Gone",
  status: 410,
  detail: "its server is gone",
  hint: "begin anew",
};

async function played(
  answer: (request: string, body: unknown) => [number, unknown],
): Promise<[Session, string[]]> {
  vi.useFakeTimers();
  const asked = answering(answer);
  const session = new Session({ builtin: "simple-pendulum" });
  await session.start();
  streams[0]?.onopen?.();
  streams[0]?.onmessage?.({ data: JSON.stringify({ type: "state", ...state("AA-1", 3.5) }) });
  expect(session.latest?.time).toBe(3.5);
  // Its server ends, and whoever is asked then knows that it is gone.
  streams[0]?.onclose?.();
  await vi.runAllTimersAsync();
  return [session, asked];
}

test("where the server of a run is gone the page begins it elsewhere, at the time that was reached", async () => {
  let servers = 0;
  const [session, asked] = await played((request, body) => {
    if (request.endsWith("POST /api/v1/sessions")) return [201, state(servers++ ? "BB-2" : "AA-1", 0)];
    if (request.includes("AA-1")) return [410, GONE];
    return [200, state("BB-2", (body as { seconds?: number } | null)?.seconds ?? 0)];
  });
  expect(session.latest?.id).toBe("BB-2");
  expect(session.latest?.time).toBe(3.5);
  expect(asked.slice(1)).toEqual([
    "GET /api/v1/sessions/AA-1",
    'POST /api/v1/sessions {"builtin":"simple-pendulum"}',
    'POST /api/v1/sessions/BB-2/step {"seconds":3.5}',
  ]);
  expect(streams.map(({ url }) => url.split("/sessions/")[1])).toEqual(["AA-1/stream", "BB-2/stream"]);
});

test("a run whose server only does not answer yet is waited for", async () => {
  let silent = 2;
  const [session, asked] = await played((request) => {
    if (request.startsWith("POST")) return [201, state("AA-1", 0)];
    return silent-- > 0 ? [503, { ...GONE, code: "node-away", status: 503 }] : [200, state("AA-1", 4)];
  });
  expect(session.latest?.id).toBe("AA-1");
  expect(asked.filter((name) => name.startsWith("POST"))).toHaveLength(1);
  expect(streams).toHaveLength(2);
});

/** The requests that were answered, each in a turn of its own. */
async function settled(): Promise<void> {
  for (let turn = 0; turn < 50; turn++) await Promise.resolve();
  await new Promise((done) => setTimeout(done, 0));
}

test("what is pressed before the run is there, or while it answers, is done in order", async () => {
  const asked = answering((request, body) => {
    if (request.endsWith("POST /api/v1/sessions")) return [201, state("AA-1", 0)];
    const by = (body as { steps?: number; seconds?: number } | null) ?? {};
    return [200, state("AA-1", request.endsWith("step") ? 0.25 : (by.seconds ?? 0))];
  });
  const session = new Session({ builtin: "simple-pendulum" });
  const started = session.start();
  const steps = [session.step({ steps: 1 }), session.step({ seconds: 0.1 }), session.forward()];
  session.lookFrom("side");
  session.setSpeed(2);
  void session.toggle();
  void session.toggle();
  void session.toggle();
  await started;
  await Promise.all(steps);
  await settled();
  expect(asked).toEqual([
    'POST /api/v1/sessions {"builtin":"simple-pendulum"}',
    'POST /api/v1/sessions/AA-1/step {"steps":1}',
    'POST /api/v1/sessions/AA-1/step {"seconds":0.1}',
    'POST /api/v1/sessions/AA-1/step {"steps":1}',
    'PUT /api/v1/sessions/AA-1/camera {"from":"side"}',
    'POST /api/v1/sessions/AA-1/play {"speed":2}',
  ]);
  expect(session.pending).toBe(false);
});

test("what is changed while looking back acts at the newest moment, and that is told", async () => {
  let reached = 2;
  answering((request) => {
    if (request.endsWith("POST /api/v1/sessions")) return [201, state("AA-1", 0)];
    return [200, state("AA-1", reached)];
  });
  const session = new Session({ builtin: "simple-pendulum" });
  await session.start();
  await session.step({ seconds: 2 });
  session.seek(0.5);
  await session.pull({ body: "bob", point: [0, 0, 0], to: [1, 0, 0] });
  expect(session.time).toBe(2);
  expect(vi.mocked(banner).mock.lastCall?.[0]).toBe(
    "The change acts at the newest moment, 2.000 s: you were looking back at 0.500 s.",
  );
  // At the newest moment, and where the run begins anew, there is nothing to tell.
  vi.mocked(banner).mockClear();
  await session.pull(null);
  session.seek(0.5);
  reached = 0;
  await session.pull(null);
  expect(session.time).toBe(0);
  expect(banner).not.toHaveBeenCalled();
});

test("a time to run to is not forgotten before the run is there, nor is what is pressed lost with a run that is gone", async () => {
  let servers = 0;
  const asked = answering((request, body) => {
    if (request.endsWith("POST /api/v1/sessions")) return [201, state(servers++ ? "BB-2" : "AA-1", 0)];
    if (request.includes("AA-1")) return [410, GONE];
    const { seconds = 0 } = (body ?? {}) as { seconds?: number };
    return [200, state("BB-2", seconds)];
  });
  const session = new Session({ builtin: "simple-pendulum" });
  const ran = session.goTo(2);
  void session.step({ steps: 3 });
  void session.step({ steps: 4 });
  await session.start();
  await settled();
  await ran;
  expect(asked.slice(1)).toEqual([
    'POST /api/v1/sessions/AA-1/step {"steps":3}',
    'POST /api/v1/sessions {"builtin":"simple-pendulum"}',
    'POST /api/v1/sessions/BB-2/step {"steps":4}',
    'POST /api/v1/sessions/BB-2/step {"seconds":2}',
  ]);
});

test("a step, a reset and the time line show the run again, not the analysis over it", async () => {
  answering((request, body) => {
    if (request.endsWith("POST /api/v1/sessions")) return [201, state("AA-1", 0)];
    return [200, state("AA-1", (body as { seconds?: number } | null)?.seconds ?? 0)];
  });
  const session = new Session({ builtin: "simple-pendulum" });
  await session.start();
  await session.step({ seconds: 2 });
  const ways = {
    step: () => session.step({ seconds: 1 }),
    seek: () => session.seek(0.5),
    goTo: () => session.goTo(0.2),
    play: () => session.play(),
    reset: () => session.reset(),
  };
  for (const [name, way] of Object.entries(ways)) {
    session.setPose({ bodies: [] });
    await way();
    expect(session.pose, name).toBeUndefined();
  }
});

test("an undo that the server did not answer is not used up", async () => {
  let there = true;
  const parameters = [{ name: "g", initial: 9.81, value: 9.81 }];
  answering((request) => {
    if (!there) throw new TypeError("Failed to fetch");
    if (request.endsWith("POST /api/v1/sessions")) return [201, state("AA-1", 0)];
    if (request.includes("scene")) return [200, { parameters, scene: {}, original: {} }];
    return [200, state("AA-1", 0)];
  });
  const session = new Session({ builtin: "simple-pendulum" });
  await session.start();
  await settled();
  for (const g of [4, 6]) await session.change({ values: { g }, places: {} });
  there = false;
  await expect(session.undo()).rejects.toThrow();
  await expect(Promise.all([session.undo(), session.undo()])).rejects.toThrow();
  expect(session.canUndo).toBe(true);
  there = true;
  await session.undo();
  expect(session.numbers.values).toEqual({ g: 4 });
  await Promise.all([session.undo(), session.undo()]);
  expect(session.numbers.values).toEqual({});
  expect(session.canUndo).toBe(false);
});
