// Names for the types of the API. They are generated from the server's OpenAPI document by `npm run types`.
import type { components } from "./schema";

type Schemas = components["schemas"];

export type Vec3 = [number, number, number];

export type Accuracy = Schemas["Accuracy"];
export type AfterChange = Schemas["AfterChange"];
export type Answer = Schemas["Answer"];
export type Body = Schemas["Body"];
export type BodyState = Schemas["BodyState"];
export type Camera = Schemas["Camera"];
export type CheckReport = Schemas["CheckReport"];
export type Drag = Schemas["Drag"];
export type Drawing = Schemas["Drawing"];
export type GradedSubmission = Schemas["GradedSubmission"];
export type Jacobian = Schemas["Jacobian"];
export type Joint = Schemas["Joint"];
export type IntegratorKind = Schemas["IntegratorKind"];
export type JointForce = Schemas["JointForce"];
export type JointMultipliers = Schemas["JointMultipliers"];
export type LectureQuestion = Schemas["LectureQuestion"];
export type LectureState = Schemas["LectureState"];
export type Lesson = Schemas["Lesson"];
export type LessonSummary = Schemas["LessonSummary"];
export type Mark = Schemas["Mark"];
export type Orientation = Schemas["Orientation"];
/** The page reports some problems itself: a title is what all of them have. */
export type Problem = Pick<Schemas["Problem"], "title"> & Partial<Schemas["Problem"]>;
export type Question = Schemas["Question"];
export type QuestionVerdict = Schemas["ToldQuestion"];
export type Reaction = Schemas["Reaction"];
export type Reactions = Schemas["Reactions"];
export type Scene = Schemas["Scene"];
export type SceneEntry = Schemas["SceneEntry"];
export type SessionParameter = Schemas["SessionParameter"];
export type SessionScene = Schemas["SessionScene"];
export type SessionState = Schemas["SessionState"];
export type Shape = Schemas["Shape"];
export type SymmetricMatrix = Schemas["SymmetricMatrix"];
export type TableRequest = Schemas["TableRequest"];
export type Tally = Schemas["Tally"];
export type MatrixPart = Schemas["MatrixPart"];
export type ModesAbout = Schemas["ModesAbout"];
export type Output = Schemas["Output"];
export type OpenedLecture = Schemas["OpenedLecture"];
export type PresenterState = Schemas["PresenterState"];
export type ImportedRobot = Schemas["ImportedRobot"];
export type ClassView = Schemas["ClassView"];
export type GradeTable = Schemas["GradeTable"];
export type KeptSubmission = Schemas["KeptSubmission"];
export type Me = Schemas["Me"];
export type Reached = Schemas["Reached"];
export type Somebody = Schemas["Somebody"];
export type StudentRow = Schemas["StudentRow"];
export type Welcome = Schemas["Welcome"];
export type Hint = Schemas["Hint"];
export type Understood = Schemas["Understood"];
