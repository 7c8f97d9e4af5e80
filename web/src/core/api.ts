// The one door to the server. Every failure becomes an ApiError that carries a Problem.
import type { Numbers, SceneView, Then } from "./numbers";
import type {
  Answer, CheckReport, Jacobian, JointMultipliers, Lesson, LessonSummary, Problem, Scene,
  Pull, Reactions, SceneSummary, SessionState, Verdict,
} from "./types";

const BASE = "/api/v1";

export class ApiError extends Error {
  constructor(readonly problem: Problem) {
    super(problem.detail ?? problem.title);
  }

  /** True when the server could not be reached at all. */
  get offline(): boolean {
    return this.problem.code === "server-unreachable";
  }

  get gone(): boolean {
    return this.problem.status === 404 || this.problem.status === 410;
  }
}

/** Any thrown value as a Problem that can be shown. */
export function problemOf(error: unknown): Problem {
  if (error instanceof ApiError) return error.problem;
  const detail = error instanceof Error ? error.message : String(error);
  return { title: "Something in this page failed", detail, hint: "Reload the page; if it happens again, report the text above." };
}

async function failure(response: Response): Promise<ApiError> {
  const fallback: Problem = {
    title: `The server answered ${response.status} ${response.statusText}`.trim(),
    status: response.status,
    hint: "Try again in a moment.",
  };
  const kind = response.headers.get("content-type") ?? "";
  if (!kind.includes("json")) return new ApiError(fallback);
  try {
    const body = (await response.json()) as Partial<Problem>;
    return new ApiError({ ...fallback, hint: undefined, ...body });
  } catch {
    return new ApiError(fallback);
  }
}

async function call<T>(method: string, path: string, body?: unknown, signal?: AbortSignal): Promise<T> {
  let response: Response;
  try {
    const headers: Record<string, string> = { accept: "application/json, application/problem+json" };
    if (body !== undefined) headers["content-type"] = "application/json";
    response = await fetch(BASE + path, {
      method, headers, signal: signal ?? null,
      body: body === undefined ? null : typeof body === "string" ? body : JSON.stringify(body),
    });
  } catch (error) {
    if (signal?.aborted) throw error;
    throw new ApiError({
      title: "The server does not answer",
      code: "server-unreachable",
      detail: "The page could not reach Triad's server.",
      hint: "Is it still running? Start it again with “triad serve”; this page then carries on by itself.",
    });
  }
  if (!response.ok) throw await failure(response);
  if (response.status === 204) return undefined as T;
  return (await response.json()) as T;
}

const id = encodeURIComponent;

/** Whose numbers: a student's name, or another seed. */
const whose = (seed?: string): string => seed ? `?${new URLSearchParams({ seed })}` : "";

export type SessionSource = { lesson: string; seed?: string } | { builtin: string } | { scene: unknown };

export const api = {
  lessons: (signal?: AbortSignal) => call<LessonSummary[]>("GET", "/lessons", undefined, signal),
  lesson: (slug: string, seed: string, signal?: AbortSignal) => call<Lesson>("GET", `/lessons/${id(slug)}${whose(seed)}`, undefined, signal),
  hint: (slug: string, question: string, k: number, seed?: string) =>
    call<{ html: string }>("GET", `/lessons/${id(slug)}/questions/${id(question)}/hints/${k}${whose(seed)}`),
  statesUrl: (slug: string, question: string, seed?: string): string => `${BASE}/lessons/${id(slug)}/questions/${id(question)}/states${whose(seed)}`,
  starterUrl: (slug: string, question: string, language: string): string => `${BASE}/lessons/${id(slug)}/questions/${id(question)}/starters/${language}`,
  submit: (slug: string, student: string, answers: Record<string, Answer>, seed?: string) =>
    call<Verdict>("POST", `/lessons/${id(slug)}/submissions`, seed === undefined ? { student, answers } : { student, seed, answers }),
  submissions: (query: { student: string; lesson?: string; limit?: number }, signal?: AbortSignal) => {
    const search = new URLSearchParams({ student: query.student });
    if (query.lesson) search.set("lesson", query.lesson);
    search.set("limit", String(query.limit ?? 50));
    return call<Verdict[]>("GET", `/submissions?${search}`, undefined, signal);
  },

  scenes: (signal?: AbortSignal) => call<SceneSummary[]>("GET", "/scenes", undefined, signal),
  scene: (name: string, signal?: AbortSignal) => call<Scene>("GET", `/scenes/${id(name)}`, undefined, signal),
  check: (sceneText: string, signal?: AbortSignal) => call<CheckReport>("POST", "/check", sceneText, signal),

  analyse: <T>(kind: "assembly" | "kinematics" | "equilibrium" | "modes", asked: { scene: unknown }) => call<T>("POST", `/analyses/${kind}`, asked),
  createSession: (source: SessionSource, change?: Numbers) => call<SessionState>("POST", "/sessions", change ? { ...source, change } : source),
  sceneOf: (session: string) => call<SceneView>("GET", `/sessions/${id(session)}/scene`),
  change: (session: string, numbers: Numbers, then?: Then) =>
    call<SessionState>("POST", `/sessions/${id(session)}/parameters`, then ? { ...numbers, then } : numbers),
  pull: (session: string, pull: Pull) => call<SessionState>("PUT", `/sessions/${id(session)}/pull`, pull),
  release: (session: string) => call<SessionState>("DELETE", `/sessions/${id(session)}/pull`),
  reactions: (session: string, asked: { on: string; about: string; in: string }) =>
    call<Reactions>("GET", `/sessions/${id(session)}/reactions?${new URLSearchParams(asked)}`),
  session: (session: string) => call<SessionState>("GET", `/sessions/${id(session)}`),
  step: (session: string, by: { steps: number } | { seconds: number }) =>
    call<SessionState>("POST", `/sessions/${id(session)}/step`, by),
  play: (session: string, speed: number) => call<SessionState>("POST", `/sessions/${id(session)}/play`, { speed }),
  pause: (session: string) => call<SessionState>("POST", `/sessions/${id(session)}/pause`),
  reset: (session: string) => call<SessionState>("POST", `/sessions/${id(session)}/reset`),
  jacobian: (session: string) => call<Jacobian>("GET", `/sessions/${id(session)}/jacobian`),
  multipliers: (session: string) => call<JointMultipliers[]>("GET", `/sessions/${id(session)}/multipliers`),
  /** Sent while the page goes away, so nobody waits for the answer. */
  dropSession: (session: string): void => {
    void fetch(`${BASE}/sessions/${id(session)}`, { method: "DELETE", keepalive: true }).catch(() => undefined);
  },
  streamUrl: (session: string): string => {
    const url = new URL(`${BASE}/sessions/${id(session)}/stream`, location.href);
    url.protocol = url.protocol === "https:" ? "wss:" : "ws:";
    return url.href;
  },
};
