// The catalogue of the page's texts: the English text, and what it is in German. Lessons and scenes speak English.
import { classroom } from "./de/class";
import { frame } from "./de/frame";
import { inspector } from "./de/inspector";
import { learning } from "./de/learning";

export const de = { ...frame, ...learning, ...inspector, ...classroom };
export type German = typeof de;
