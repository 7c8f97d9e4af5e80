// A clicker's keys go to the window that has the focus, which is the projector's as often as not: it hands them on.

export type ScreenKey = "next" | "before" | "blank";

export const screenKeys = (code: string): BroadcastChannel => new BroadcastChannel(`triad-room-${code}`);
