// Generated from server/openapi.json by `npm run types`: do not edit.

export type paths = Record<string, never>;
export type webhooks = Record<string, never>;
export interface components {
    schemas: {
        /** @description Estimated errors of a state, each the largest over all bodies or joints: what the run has collected since its start. */
        Accuracy: {
            /**
             * Format: double
             * @description Of angular velocities, rad/s.
             */
            angular_velocity: number;
            /**
             * Format: double
             * @description Of the energy, J.
             */
            energy: number;
            /**
             * Format: double
             * @description Of forces in joints and drivers, N; absent where the state tells no forces.
             */
            force?: number | null;
            /**
             * Format: double
             * @description Of their moments, N m.
             */
            moment?: number | null;
            /**
             * Format: double
             * @description Of centres of mass, m.
             */
            position: number;
            /**
             * Format: double
             * @description Of directions, rad.
             */
            turn: number;
            /**
             * Format: double
             * @description Of velocities of centres of mass, m/s.
             */
            velocity: number;
        };
        /** @description What happens to a run whose scene is changed. */
        AfterChange: "restart" | "continue";
        /** @description A scene to analyse. */
        AnalysisRequest: {
            /**
             * @description Modes about the `equilibrium` near the start, or about the `start` itself.
             * @default equilibrium
             */
            about?: components["schemas"]["ModesAbout"];
            /**
             * @description Bodies that an assembly must not move.
             * @default []
             */
            pinned?: string[];
            /** @description The scene; its schema is at /api/v1/schema/scene. */
            scene: components["schemas"]["Scene"];
        };
        /** @description The answer to one question. */
        Answer: {
            /** @description The id of the option that was chosen. */
            choice?: string | null;
            /** @description Forces and moments on bodies that are cut free. */
            diagram?: components["schemas"]["Arrow"][] | null;
            /** @description The text of a file: JSON or CSV of a program, a table, a scene. */
            file?: string | null;
            /** @description Settings of a run. */
            settings?: components["schemas"]["RunSettings"] | null;
            /** @description The unit of the value, as typed. */
            unit?: string | null;
            /** @description A number, a list of numbers, or a formula, as typed. */
            value?: components["schemas"]["TypedValue"] | null;
        };
        /** @description How to apply a preview. */
        Application: {
            /** @description What counts. */
            choice: components["schemas"]["Choice"];
            /** @description Why: students see it. */
            reason: string;
        };
        /** @description A regrade that was applied. */
        AppliedRegrade: {
            /** @description When. */
            at: string;
            /** @description Who asked for it. */
            by: string;
            /** @description What counted: `replace` or `better`. */
            choice: string;
            /** @description Its id. */
            id: string;
            /** @description Slug of the lesson. */
            lesson: string;
            /** @description Why. */
            reason: string;
            /** @description When it was taken back. */
            undone?: string | null;
        };
        /** @description A force or a moment in a diagram. */
        Arrow: {
            /** @description Along or about which axis of the ground frame, and in which sense. */
            along: components["schemas"]["Sense"];
            /** @description Where: a joint or driver, `centre` for the centre of mass, or another point of the picture. */
            at: string;
            /** @description Force or moment. */
            kind: components["schemas"]["ArrowKind"];
            /** @description The body on which it acts. */
            on: string;
        };
        /** @description What an arrow stands for. */
        ArrowKind: "force" | "moment";
        /** @description Which forces are drawn, and by which convention. */
        Arrows: {
            /**
             * @description About which point: there the force is drawn and the moment taken.
             * @default joint
             */
            about?: components["schemas"]["MomentPoint"];
            /**
             * @description Which of them.
             * @default all
             */
            drawn?: components["schemas"]["DrawnForces"];
            /**
             * @description The joint that is marked, because somebody selected it or its rows.
             * @default null
             */
            marked?: string | null;
            /**
             * @description On the first or on the second body of each joint.
             * @default j
             */
            on?: components["schemas"]["Side"];
        };
        /** @description Something to be explained. */
        AskedExplanation: {
            /** @description A good explanation, as safe HTML. */
            good_html: string;
            /** @description Id of the question. */
            id: string;
            /**
             * Format: uint
             * @description Its place in the exercise.
             */
            place: number;
            /**
             * Format: double
             * @description Points that people can give.
             */
            points: number;
            /** @description What is asked, as safe HTML. */
            prompt_html: string;
            /**
             * Format: uint
             * @description How many explanations wait for their points.
             */
            waiting: number;
        };
        /** @description Something to be predicted. */
        AskedPrediction: {
            /** @description Whether a sentence why is asked for, too. */
            asks_why: boolean;
            /** @description Id of the option that comes true. */
            happens: string;
            /** @description What is asked, as safe HTML. */
            html: string;
            /** @description Id under which the prediction is sent. */
            id: string;
            /** @description What may happen. */
            options: components["schemas"]["ChoiceOption"][];
            /**
             * Format: double
             * @description Points for having predicted, right or wrong.
             */
            points: number;
            /**
             * Format: double
             * @description When the run has shown what happens, s.
             */
            seen_at: number;
            /** @description Parameters of the scene to set before the run, by name. */
            with?: {
                [key: string]: number;
            };
        };
        /** @description What assembly did. */
        Assembly: {
            /** @description The bodies, in the scene's order. */
            bodies: components["schemas"]["Placement"][];
            /**
             * Format: uint
             * @description Newton steps.
             */
            iterations: number;
            /**
             * Format: double
             * @description Largest violation that is left, m.
             */
            left: number;
            /** @description What has to be known of the result. */
            notes: string[];
            /**
             * Format: double
             * @description Largest violation of positions at the given start, m.
             */
            opening: number;
        };
        /** @description How a lesson is assigned. */
        AssignedLesson: {
            /** @description Extensions, by person. */
            extensions: components["schemas"]["PersonExtension"][];
            /**
             * Format: uint32
             * @description Its place in the course.
             */
            number: number;
            /**
             * Format: uint
             * @description How many people handed in.
             */
            people: number;
            /** @description What is set. */
            policy: components["schemas"]["Policy"];
            /** @description When the results were released. */
            released?: string | null;
            /** @description Slug of the lesson. */
            slug: string;
            /** @description Its title. */
            title: string;
            /** @description Its version: whoever sends it with another policy overwrites nothing that was set meanwhile. */
            version: string;
        };
        /** @description How the lessons are assigned, in the order of the course. */
        AssignmentList: components["schemas"]["AssignedLesson"][];
        /** @description A mass that is part of a body. */
        AttachedMass: {
            /** @description Its inertia about its own centre, along the axes of the body's frame; without it a point mass. */
            inertia?: components["schemas"]["Inertia"] | null;
            /**
             * Format: double
             * @description Mass, kg; positive.
             */
            mass: number;
            /** @description Its centre in the body's frame, m. */
            point?: [
                number,
                number,
                number
            ];
        };
        /** @description An axis of the ground frame. */
        Axis: "x" | "y" | "z";
        /** @description How the axis of a revolute joint is written. */
        AxisRows: "cp-2car" | "cp-cv" | "shared";
        /** @description A rigid body. */
        Body: {
            /** @description Angular velocity in the world frame, rad/s. */
            angular_velocity?: [
                number,
                number,
                number
            ];
            /** @description Masses that are part of the body; `mass`, `inertia` and `center_of_mass` are those of the body without them. */
            attached?: components["schemas"]["AttachedMass"][];
            /** @description Centre of mass in the body's frame, m. */
            center_of_mass?: [
                number,
                number,
                number
            ];
            /** @description Coordinates of this body, if not those of the scene. */
            coordinates?: components["schemas"]["Coordinates"] | null;
            /** @description Inertia about the centre of mass; without it the body is a point mass. */
            inertia?: components["schemas"]["Inertia"] | null;
            /**
             * Format: double
             * @description Mass, kg; positive.
             */
            mass: number;
            /** @description Unique name. */
            name: string;
            /** @description Orientation of the body's frame in the world. */
            orientation?: components["schemas"]["Orientation"] | null;
            /**
             * @description Position of the body's reference point in the world, m.
             * @default [
             *       0,
             *       0,
             *       0
             *     ]
             */
            position?: [
                number,
                number,
                number
            ];
            /** @description What to draw; no influence on the motion. */
            shape?: components["schemas"]["Shape"][];
            /** @description Velocity of the reference point in the world frame, m/s. */
            velocity?: [
                number,
                number,
                number
            ];
        };
        /** @description A body at one moment, in the world frame. */
        BodyFrame: {
            /** @description Angular velocity, rad/s. */
            angular_velocity: [
                number,
                number,
                number
            ];
            /** @description Centre of mass, m. */
            position: [
                number,
                number,
                number
            ];
            /** @description Director u, a principal axis. */
            u: [
                number,
                number,
                number
            ];
            /** @description Director v. */
            v: [
                number,
                number,
                number
            ];
            /** @description Velocity of the centre of mass, m/s. */
            velocity: [
                number,
                number,
                number
            ];
            /** @description Director w. */
            w: [
                number,
                number,
                number
            ];
        };
        /** @description The spin of one body. */
        BodySpin: {
            /** @description The body. */
            body: string;
            /**
             * Format: double
             * @description Angular velocity in the frame, rad/s.
             */
            rate: number;
        };
        /** @description A body at the session's time. */
        BodyState: {
            /** @description Acceleration of the centre of mass in the world, m/s². */
            acceleration: [
                number,
                number,
                number
            ];
            /** @description Angular velocity in the world, rad/s. */
            angular_velocity: [
                number,
                number,
                number
            ];
            /**
             * Format: double
             * @description Mass, kg.
             */
            mass: number;
            /** @description Name. */
            name: string;
            /** @description Centre of mass in the world, m. */
            position: [
                number,
                number,
                number
            ];
            /** @description First principal axis in the world. */
            u: [
                number,
                number,
                number
            ];
            /** @description Second principal axis in the world. */
            v: [
                number,
                number,
                number
            ];
            /** @description Velocity of the centre of mass in the world, m/s. */
            velocity: [
                number,
                number,
                number
            ];
            /** @description Third principal axis in the world. */
            w: [
                number,
                number,
                number
            ];
        };
        /** @description The verdicts of a submission side by side. */
        BothVerdicts: {
            /** @description As it would be told; left out where the new lesson cannot grade it. */
            after?: components["schemas"]["GradedSubmission"] | null;
            /** @description As it was told. */
            before: components["schemas"]["GradedSubmission"];
        };
        /** @description A lesson in which somebody is. */
        BusyLesson: {
            /**
             * Format: uint32
             * @description Its place in the course.
             */
            number: number;
            /** @description Who, by name. */
            people: components["schemas"]["Present"][];
            /** @description Slug of the lesson. */
            slug: string;
            /** @description Its title. */
            title: string;
        };
        /** @description From where the mechanism is looked at. */
        Camera: "corner" | "front" | "side" | "above";
        /** @description A gradebook that Canvas exported. */
        CanvasExport: {
            /** @description The file as text. */
            file: string;
        };
        /** @description How a submission comes out. */
        Changed: "same" | "words" | "up" | "down" | "gradable" | "failed";
        /** @description Bodies, coordinates, rows, rank, degrees of freedom and redundant rows of a scene. */
        CheckReport: {
            /**
             * Format: uint
             * @description Moving bodies.
             */
            bodies: number;
            /**
             * Format: uint
             * @description Generalized coordinates.
             */
            coordinates: number;
            /**
             * Format: uint
             * @description Degrees of freedom: coordinates less rank.
             */
            degrees_of_freedom: number;
            /** @description Name of the scene. */
            name: string;
            /** @description What was found or corrected. */
            notes: string[];
            /**
             * Format: uint
             * @description Rank of those rows near the start.
             */
            rank: number;
            /** @description Rows that depend on others, joint by joint. */
            redundant: components["schemas"]["RedundantRows"][];
            /**
             * Format: uint
             * @description Constraint rows, those of rigid bodies included.
             */
            rows: number;
        };
        /** @description What counts of a regrade. */
        Choice: "replace" | "better";
        /** @description An option and how often it was chosen. */
        ChoiceCount: {
            /**
             * Format: uint
             * @description Students who chose it first.
             */
            first: number;
            /** @description The option, as safe HTML. */
            html: string;
            /** @description Id of the option. */
            id: string;
            /**
             * Format: uint
             * @description Students who chose it last.
             */
            last: number;
            /** @description Whether it is right. */
            right: boolean;
        };
        /** @description An option as a student sees it. */
        ChoiceOption: {
            /** @description The option as safe HTML. */
            html: string;
            /** @description Id to send. */
            id: string;
        };
        /** @description What is to change; what is left out stays. */
        ClassChange: {
            /**
             * @description Whether students may join.
             * @default null
             */
            join_open?: boolean | null;
            /**
             * @description Another code; the one of before opens nothing any more.
             * @default false
             */
            new_code?: boolean;
            /**
             * @description The title.
             * @default null
             */
            title?: string | null;
        };
        /** @description The class. */
        ClassView: {
            /** @description What students type to join. */
            join_code: string;
            /** @description Whether they may. */
            join_open: boolean;
            /** @description Its title. */
            title: string;
        };
        /** @description What a class predicted and explained in a lesson. */
        ClassWords: {
            /** @description What was to be explained. */
            explanations: components["schemas"]["AskedExplanation"][];
            /** @description What was to be predicted. */
            predictions: components["schemas"]["AskedPrediction"][];
            /** @description Slug of the lesson. */
            slug: string;
            /** @description Students who predicted or explained something, by name. */
            students: components["schemas"]["StudentWords"][];
        };
        /** @description The column of a lesson. */
        ColumnView: {
            /**
             * Format: uint32
             * @description Those that were refused so often that they wait for somebody to ask for it.
             */
            given_up: number;
            /** @description When one was sent last. */
            last?: string | null;
            /** @description Slug of the lesson. */
            lesson: string;
            /** @description Why the last one that waits was refused; empty if none was. */
            problem: string;
            /** @description Whether the platform has it; else it is asked for one. */
            ready: boolean;
            /**
             * Format: uint32
             * @description Scores that belong there.
             */
            scores: number;
            /**
             * Format: uint32
             * @description Those that the platform has.
             */
            sent: number;
        };
        /** @description Somebody who comes back: by name and words, or by a link. */
        ComeBack: {
            /**
             * @description The secret of a link, instead of both.
             * @default null
             */
            link?: string | null;
            /**
             * @description The name.
             * @default
             */
            name?: string;
            /**
             * @description The four words.
             * @default
             */
            words?: string;
        };
        /** @description Which generalized coordinates describe a body. */
        Coordinates: "full" | "reduced" | "shared";
        /** @description How many submissions came out how. */
        Counts: {
            /**
             * Format: uint
             * @description Fewer points.
             */
            down: number;
            /**
             * Format: uint
             * @description Cannot be graded by the new lesson: the verdict of before stays.
             */
            failed: number;
            /**
             * Format: uint
             * @description Could be judged before or can be now, and not both.
             */
            gradable: number;
            /**
             * Format: uint
             * @description This program differs from the one that graded them, with the same lesson.
             */
            program: number;
            /**
             * Format: uint
             * @description The same in every word.
             */
            same: number;
            /**
             * Format: uint
             * @description More points.
             */
            up: number;
            /**
             * Format: uint
             * @description The same points in other words.
             */
            words: number;
        };
        /** @description A course of the platform. */
        CourseView: {
            /** @description Whether its people can be taken over. */
            roster: boolean;
            /** @description Its title there. */
            title: string;
        };
        /** @description What an attempt counts. */
        Credit: {
            /** @description When it came. */
            at: string;
            /**
             * Format: uint32
             * @description Which attempt it is, from 1.
             */
            attempt: number;
            /**
             * Format: double
             * @description Points that it earned.
             */
            earned: number;
            /** @description The submission. */
            id: string;
            /**
             * Format: double
             * @description The share that counts of this attempt.
             */
            of_attempt: number;
            /**
             * Format: double
             * @description The share that counts at that moment.
             */
            on_time: number;
            /**
             * Format: double
             * @description The points that count: the product.
             */
            points: number;
        };
        /** @description A body that is cut free. */
        CutBody: {
            /** @description Its name. */
            name: string;
            /** @description Where arrows may be put. */
            places: components["schemas"]["CutPlace"][];
        };
        /** @description A point of a body. */
        CutPlace: {
            /** @description Its place in the picture, px from the left and from above. */
            at: [
                number,
                number
            ];
            /** @description Name to send. */
            id: string;
            /** @description Name for people. */
            label: string;
        };
        /** @description What somebody decided about the points. */
        Decided: {
            /** @description When. */
            at: string;
            /** @description Who decided. */
            by: string;
            /**
             * Format: double
             * @description The points that count; left out: those that were earned.
             */
            points?: number | null;
            /** @description Why. */
            reason: string;
        };
        /** @description Bodies cut free: their picture and the points where arrows may be put. */
        DiagramChoices: {
            /** @description Whether a positive moment turns anticlockwise in the picture. */
            anticlockwise: boolean;
            /** @description Axes of the ground frame to the right, up, and out of the picture. */
            axes: [
                components["schemas"]["Axis"],
                components["schemas"]["Axis"],
                components["schemas"]["Axis"]
            ];
            /** @description The bodies, each with its points. */
            bodies: components["schemas"]["CutBody"][];
            /** @description The picture without arrows, as SVG that the grader drew; empty if the scene does not run so far. */
            picture_svg: string;
            /** @description Width and height of the picture, px. */
            size: [
                number,
                number
            ];
            /**
             * Format: double
             * @description The moment that is shown, s.
             */
            time: number;
        };
        /** @description A spring from a point of a body to a place in the world. */
        Drag: {
            /** @description The body. */
            body: string;
            /**
             * @description The point, from the centre of mass along the body's principal axes, m.
             * @default [
             *       0,
             *       0,
             *       0
             *     ]
             */
            point?: [
                number,
                number,
                number
            ];
            /**
             * Format: double
             * @description Stiffness, N/m; one that suits the body's mass if it is not given.
             * @default null
             */
            stiffness?: number | null;
            /** @description Where it is dragged to, in the world, m. */
            to: [
                number,
                number,
                number
            ];
        };
        /** @description How forces are drawn in the viewer, for the page to do alike. */
        Drawing: {
            /**
             * @description About which point: there the force is drawn and the moment taken.
             * @default joint
             */
            about: components["schemas"]["MomentPoint"];
            /** @description From where the mechanism is looked at. */
            camera: components["schemas"]["Camera"];
            /**
             * @description Which of them.
             * @default all
             */
            drawn: components["schemas"]["DrawnForces"];
            /**
             * Format: double
             * @description Length of a force's arrow, m/N.
             */
            force_scale: number;
            /**
             * Format: double
             * @description The longest arrow, m; what would be longer is drawn as two in a row.
             */
            longest: number;
            /**
             * @description The joint that is marked, because somebody selected it or its rows.
             * @default null
             */
            marked: string | null;
            /**
             * Format: double
             * @description Length of a moment's arrow, m/(N m).
             */
            moment_scale: number;
            /**
             * @description On the first or on the second body of each joint.
             * @default j
             */
            on: components["schemas"]["Side"];
        };
        /** @description Which forces are drawn. */
        DrawnForces: "none" | "all" | {
            joint: string;
        } | {
            body: string;
        };
        /** @description Facility of first answers by halves of the class: those who drew a small number, and those who drew a large one. */
        DrawnNumber: {
            /** @description The others. */
            above: [
                number,
                number
            ];
            /** @description Students below, and their facility. */
            below: [
                number,
                number
            ];
            /**
             * Format: double
             * @description The upper half begins here.
             */
            border: number;
            /**
             * Format: double
             * @description The difference in standard errors; absent where nothing varies.
             */
            deviations?: number | null;
            /** @description Name of the number. */
            name: string;
            /** @description Whether that is more than chance. */
            unequal: boolean;
        };
        /**
         * @description What moves as prescribed. Points and vectors of bodies are in the frame of their body, those of the ground in the
         *     world.
         */
        Driver: {
            /** @description The body. */
            body: string;
            /** @description Its path in the world, m. */
            motion: components["schemas"]["VectorMotion"];
            /** @description Unique name. */
            name: string;
            /** @description The point in the body's frame, m. */
            point: [
                number,
                number,
                number
            ];
            /** @constant */
            type: "point";
        } | {
            /** @description The body. */
            body: string;
            /** @description Its direction in the world: `fixed` or `turning` unit vectors. */
            motion: components["schemas"]["VectorMotion"];
            /** @description Unique name. */
            name: string;
            /** @constant */
            type: "vector";
            /** @description The vector in the body's frame; made a unit vector. */
            vector: [
                number,
                number,
                number
            ];
        } | {
            /** @description The joint. */
            joint: string;
            /** @description Angle of body j relative to body i about the axis, from where the joint's angle is zero, rad. */
            motion: components["schemas"]["Motion"];
            /** @description Unique name. */
            name: string;
            /** @constant */
            type: "angle";
        } | {
            /** @description The joint. */
            joint: string;
            /** @description Distance from the joint's point on body i to that on body j along the axis, m. */
            motion: components["schemas"]["Motion"];
            /** @description Unique name. */
            name: string;
            /** @constant */
            type: "slide";
        } | {
            /** @description First body, or `ground`. */
            body_i: string;
            /** @description Second body, or `ground`. */
            body_j: string;
            /** @description The angle, rad. */
            motion: components["schemas"]["Motion"];
            /** @description Unique name. */
            name: string;
            /** @constant */
            type: "angle-cosine";
            /** @description Vector in the frame of body i; made a unit vector. */
            vector_i: [
                number,
                number,
                number
            ];
            /** @description Vector in the frame of body j; made a unit vector. */
            vector_j: [
                number,
                number,
                number
            ];
        } | {
            /** @description The body. */
            body: string;
            /** @description The angle, rad. */
            motion: components["schemas"]["Motion"];
            /** @description Unique name. */
            name: string;
            /** @description Vector of the world; one that is fixed or turns is made a unit vector. */
            reference: components["schemas"]["VectorMotion"];
            /** @constant */
            type: "angle-to-world";
            /** @description Vector in the body's frame; made a unit vector. */
            vector: [
                number,
                number,
                number
            ];
        };
        /** @description A part of the equations. */
        EquationPart: "phi" | "jacobian" | "gamma" | "mass" | "acceleration";
        /** @description A position of rest. */
        Equilibrium: {
            /** @description The bodies, at rest. */
            bodies: components["schemas"]["BodyFrame"][];
            /**
             * Format: double
             * @description How far the bodies may be from rest, m, rotations times the mechanism's length: what is left of the forces, or their rounding, over the
             *     stiffness. `None` where some motion meets no stiffness.
             */
            error?: number | null;
            /**
             * Format: uint
             * @description Steps of the search.
             */
            iterations: number;
            /**
             * Format: double
             * @description Smallest stiffness along a small motion, N/m: a position with a negative one is left at a touch. Motions are
             *     measured by the displacements of all bodies and by their rotations times the mechanism's length, squared and
             *     added.
             */
            least_stiffness: number;
            /** @description What has to be known of the result. */
            notes: string[];
            /** @description Reactions at rest. */
            reactions: components["schemas"]["ReactionReport"];
            /**
             * Format: double
             * @description Generalized force that is left, N.
             */
            residual: number;
            /**
             * @description Whether every small displacement is driven back; undecided (`None`) where some motion meets no stiffness. Where forces have no
             *     potential, whether no small motion grows, and undecided where something damps it.
             */
            stable: boolean | null;
        };
        /** @description Whom to erase, and why. */
        Erasure: {
            /**
             * @description Keep what was handed in, without the name: where law wants examinations kept.
             * @default false
             */
            answers_stay?: boolean;
            /** @description Why: who asked for it, or which rule says so. It stays in the log. */
            reason: string;
        };
        /** @description A moment at which a number of the mechanism passes a value. A run tells when, as exactly as it knows the motion. */
        Event: {
            /** @description Unique name. */
            name: string;
            /** @description The number. */
            of: components["schemas"]["Quantity"];
            /**
             * @description In which direction.
             * @default either
             */
            passing?: components["schemas"]["Passing"];
            /**
             * @description Whether the run ends there.
             * @default false
             */
            stop?: boolean;
            /**
             * Format: double
             * @description The value that it passes, m or rad.
             */
            value: number;
        };
        /** @description An event that has happened. */
        EventOccurrence: {
            /**
             * Format: double
             * @description How far the time may be off by the estimate of the run, s: none where that is not known, and where the quantity hardly changes.
             */
            error?: number | null;
            /** @description Name of the event. */
            name: string;
            /**
             * Format: double
             * @description Rate of the quantity there, m/s or rad/s.
             */
            rate: number;
            /** @description Whether the run ends there. */
            stop: boolean;
            /**
             * Format: double
             * @description Time, s.
             */
            time: number;
        };
        /** @description The questions as a student sees them. */
        Exercise: {
            /** @description What the scene takes for granted, as safe HTML: axes, gravity, masses, inertias, positive senses. */
            conventions_html: string;
            /** @description When a right answer is shown, in words; absent if never. */
            opens?: string | null;
            /**
             * Format: double
             * @description Share of the points that passes.
             */
            pass_mark: number;
            /** @description The questions in order. */
            questions: components["schemas"]["Question"][];
        };
        /** @description What one person is allowed beyond the others. */
        Extension: {
            /** @description When. */
            at: string;
            /**
             * Format: uint32
             * @description Attempts beyond those of everybody.
             */
            attempts: number;
            /** @description Who gave it. */
            by: string;
            /** @description Why. */
            reason: string;
            /** @description Until when it counts in full; late steps and the end follow at the same distance. */
            until?: string | null;
        };
        /** @description One place in the input that is wrong. */
        Fault: {
            /** @description What is wrong there. */
            detail: string;
            /**
             * @description Where: a JSON pointer into the request body, as a URI fragment.
             * @example #/scene/joints/0/axis
             */
            pointer: string;
        };
        /** @description A table to be imported into Canvas, and what could not be filled in. */
        Filled: {
            /**
             * Format: uint
             * @description How many grades change.
             */
            changed: number;
            /** @description The table as CSV: the columns about people, and those in which something changed. */
            csv: string;
            /** @description Columns of lessons that were found. */
            found: string[];
            /** @description Names here that are not in the table, or more than once. */
            missing: string[];
            /** @description Columns of lessons with other `Points Possible` than here: Canvas takes the points as they are, and other shares from them. */
            other_points: components["schemas"]["OtherPoints"][];
            /** @description Names in the table whom nobody here has, or that stand there more than once: whose grade it is nobody knows. */
            unknown: string[];
            /** @description Lessons with grades that have no column: make an assignment of that title in Canvas, and export again. */
            without_column: string[];
        };
        /** @description What to look at in a question. */
        Flag: "easy" | "hard" | "weak";
        /**
         * @description Friction along one freedom of a joint: −(viscous ẋ + (coulomb + coefficient · radius · N) tanh(ẋ / smoothing)), where the
         *     joint's own reaction presses with N.
         */
        Friction: {
            /**
             * Format: double
             * @description Coefficient of friction between the parts that the joint's reaction presses together.
             */
            coefficient?: number;
            /**
             * Format: double
             * @description Coulomb friction at full sliding, N or N m.
             * @default 0
             */
            coulomb?: number;
            /**
             * Format: double
             * @description Distance of the two ends at which the parts touch, m, with the joint's point on body j (on body i where j is the ground)
             *     half-way: moments across the axis then press as well. Without it, forces across the axis alone.
             */
            guide?: number | null;
            /**
             * Format: double
             * @description Radius of the pin, m: needed with a coefficient about an axis, unknown along one.
             */
            radius?: number | null;
            /**
             * Format: double
             * @description Velocity at which Coulomb friction has reached three quarters, m/s or rad/s.
             * @default 0.001
             */
            smoothing?: number;
            /**
             * Format: double
             * @description Viscous coefficient, N s/m or N m s/rad.
             * @default 0
             */
            viscous?: number;
        };
        /** @description An answer that was given. */
        GivenAnswer: {
            /** @description The answer in one line. */
            answer: string;
            /** @description When. */
            at: string;
            /** @description Whether the person has earned all points since. */
            mended: boolean;
            /** @description The name. */
            name: string;
            /** @description The person's id. */
            person: string;
            /** @description The submission. */
            submission: string;
        };
        /** @description A prediction that was made, or skipped, with what the run shows. */
        GivenPrediction: {
            /** @description Id of the option that was chosen; absent if it was skipped. */
            choice?: string | null;
            /** @description When. */
            given_at: string;
            /** @description What comes true. */
            outcome: components["schemas"]["Outcome"];
            /** @description Id of the prediction. */
            prediction: string;
            /** @description Why, in the student's words; may be empty. */
            why: string;
        };
        /** @description Predictions, in the order in which they were made. */
        GivenPredictions: components["schemas"]["GivenPrediction"][];
        /** @description A verdict that was given. */
        GivenVerdict: {
            /** @description When. */
            at: string;
            /** @description What was told. */
            verdict: components["schemas"]["GradedSubmission"];
        };
        /** @description A class at a glance. */
        Glance: {
            /** @description When. */
            at: string;
            /** @description What was handed in within the last twenty minutes, the newest first: at most fifty. */
            handed: components["schemas"]["JustHanded"][];
            /**
             * Format: uint
             * @description How many that are in all.
             */
            handed_in_all: number;
            /**
             * Format: uint
             * @description How many were here within the last five minutes.
             */
            here: number;
            /** @description The lessons in which somebody is, in the order of the course. */
            lessons: components["schemas"]["BusyLesson"][];
            /** @description Who has tried one question at least three times of late, and not got it: the most tries first. */
            stuck: components["schemas"]["Stuck"][];
            /**
             * Format: uint
             * @description Students of the class.
             */
            students: number;
        };
        /** @description Students by lessons. */
        GradeTable: {
            /** @description The lessons, in the order of the course. */
            lessons: components["schemas"]["GradedLesson"][];
            /** @description Everybody who hands in, by name. */
            students: components["schemas"]["StudentRow"][];
        };
        /** @description A lesson of the table. */
        GradedLesson: {
            /**
             * Format: uint32
             * @description Its place in the course.
             */
            number: number;
            /**
             * Format: double
             * @description Points that can be earned.
             */
            possible: number;
            /** @description Its slug. */
            slug: string;
            /** @description Its title. */
            title: string;
        };
        /** @description The verdict of a submission, without what is held back. */
        GradedSubmission: {
            /**
             * Format: double
             * @description Points earned; left out while they are held back.
             */
            earned?: number | null;
            /** @description False if an answer could not be read or needs more digits: fix it and send again, no attempt is used. */
            gradable: boolean;
            /** @description What is held back: `points`, `messages`. */
            held?: string[];
            /** @description Its name. */
            id: string;
            /** @description Slug of the lesson. */
            lesson: string;
            /** @description Whether the lesson counts as passed: enough points, and nothing left that could not be read. */
            passed?: boolean | null;
            /**
             * Format: double
             * @description Points that can be earned.
             */
            possible: number;
            /** @description What graded it. */
            provenance: components["schemas"]["Provenance"];
            /** @description The questions in the lesson's order. */
            questions: components["schemas"]["ToldQuestion"][];
            /** @description The student. */
            student?: string | null;
            /** @description When it came, RFC 3339 in UTC. */
            submitted_at: string;
        };
        /** @description How the server is. */
        Health: {
            /**
             * Format: uint
             * @description Lessons in the course.
             */
            lessons: number;
            /**
             * Format: uint
             * @description Live sessions that there may be.
             */
            most_sessions: number;
            /**
             * Format: uint
             * @description Live sessions.
             */
            sessions: number;
            /** @description `ok`. */
            status: string;
            /** @description Version of the program. */
            version: string;
        };
        /** @description One hint. */
        Hint: {
            /** @description Its text. */
            html: string;
        };
        /** @description A robot as a scene. */
        ImportedRobot: {
            /** @description What could not be carried over. */
            left_out: components["schemas"]["LeftOut"][];
            /** @description The scene; its schema is at /api/v1/schema/scene. */
            scene: components["schemas"]["Scene"];
        };
        /** @description Inertia about the centre of mass along the axes of the body's frame, kg m². */
        Inertia: {
            principal: [
                number,
                number,
                number
            ];
        } | {
            tensor: [
                [
                    number,
                    number,
                    number
                ],
                [
                    number,
                    number,
                    number
                ],
                [
                    number,
                    number,
                    number
                ]
            ];
        };
        /** @description A body. */
        InstanceBody: {
            /** @description `full`: r, u, v, w; `reduced`: r, u, v and w = u × v. */
            coordinates: string;
            /**
             * Format: uint
             * @description First of its columns, from 0.
             */
            first_column: number;
            /** @description Moments of inertia about u, v, w, kg m². */
            inertia: [
                number,
                number,
                number
            ];
            /**
             * Format: double
             * @description Mass, kg.
             */
            mass: number;
            /** @description Name. */
            name: string;
        };
        /** @description A point or a vector of a body, less another one if there is one. */
        InstanceFeature: {
            /** @description The body, or `ground`. */
            body: string;
            /** @description `point` (moves with r) or `vector` (only turns). */
            kind: string;
            /** @description ξ, η, ζ along u, v, w of the body; of the ground along x, y, z. */
            local: [
                number,
                number,
                number
            ];
            /** @description What is taken off it. */
            minus?: components["schemas"]["InstanceFeature"] | null;
        };
        /** @description A number, or a prescribed one: its value and two derivatives at each state. */
        InstanceNumber: number | {
            /** @description Whether c is the cosine of what is prescribed, an angle in rad. */
            cosine_of_angle: boolean;
            /** @description What is prescribed: value, rate and second derivative at each state. */
            states: [
                number,
                number,
                number
            ][];
        };
        /** @description A row of a joint: one or three equations. */
        InstanceRow: {
            /** @description Point or vector a. */
            a: components["schemas"]["InstanceFeature"];
            /** @description Point or vector b. */
            b: components["schemas"]["InstanceFeature"];
            /** @description The number c of a product. */
            c?: components["schemas"]["InstanceNumber"] | null;
            /**
             * Format: uint
             * @description First of its rows of Φ, from 0.
             */
            first_row: number;
            /** @description `difference`: a − b = 0, three equations (CP, TP, CV, OV). `product`: a · b − c = 0, one equation. */
            form: string;
            /** @description The joint and the label of the row. */
            name: string;
        };
        /** @description A state. */
        InstanceState: {
            /** @description q, in the order of the columns. */
            q: number[];
            /** @description q̇. */
            qd: number[];
            /**
             * Format: double
             * @description Time, s.
             */
            t: number;
        };
        /** @description The instances of a student, with everything that is needed to write the equations. */
        Instances: {
            /** @description What is to be returned for each state. */
            asks: components["schemas"]["EquationPart"][];
            /** @description The bodies. */
            bodies: components["schemas"]["InstanceBody"][];
            /** @description Names of all coordinates, in order. */
            columns: string[];
            /** @description `triad-states-1`. */
            format: string;
            /** @description Acceleration of gravity, m/s². */
            gravity: [
                number,
                number,
                number
            ];
            /** @description The rows of joints and drivers, in their order after the rigid-body rows. */
            joint_rows: components["schemas"]["InstanceRow"][];
            /** @description Slug of the lesson. */
            lesson: string;
            /** @description The question. */
            question: string;
            /** @description Names of all rows of Φ, in order. */
            rows: string[];
            /** @description Whose states these are. */
            seed: string;
            /** @description The states. */
            states: components["schemas"]["InstanceState"][];
        };
        /** @description The institution with whose accounts people sign in. */
        Institution: {
            /** @description Whether who is signed in has connected an account. */
            connected: boolean;
            /** @description What people call it. */
            name?: string | null;
        };
        /** @description Integrators by name. */
        IntegratorKind: "auto" | "taylor" | "dop853" | "dopri5" | "ode45" | "radau" | "rattle" | "trapezoidal";
        /** @description An invitation. */
        Invitation: {
            /** @description The secret of the link `/setup#…`, good for one person and a week. */
            token: string;
        };
        /** @description The Jacobian of the constraints: a sparse matrix whose rows and columns have names. */
        Jacobian: {
            /** @description What each column is: its body, and the coordinate. */
            columns: string[];
            /** @description Row, column, value, and whether the entry never changes; entries that are not listed are zero by structure. */
            entries: [
                number,
                number,
                number,
                boolean
            ][];
            /**
             * Format: uint
             * @description Rank near the start.
             */
            rank: number;
            /** @description Rows of which some say again what others say. */
            redundant: components["schemas"]["RedundantSet"][];
            /** @description What each row is: its joint or body, and the row. */
            rows: string[];
            /**
             * Format: double
             * @description Time, s.
             */
            time: number;
        };
        /** @description Somebody who joins. */
        Join: {
            /** @description The code on the board. */
            code: string;
            /** @description The name that the teacher knows. */
            name: string;
        };
        /**
         * @description A joint between two bodies, or between a body and the ground.
         *
         *     Its points and axes are given in the world at the start (`point`, `points`, `axis`, `axes`) or in the frames of
         *     the two bodies (`point_i`, `point_j`, `axis_i`, `axis_j`; for the ground this is the world).
         */
        Joint: {
            /** @description Two axes in the world at the start: the first fixed in body i, the second in body j. */
            axes?: [
                [
                    number,
                    number,
                    number
                ],
                [
                    number,
                    number,
                    number
                ]
            ] | null;
            /** @description Common axis in the world at the start. */
            axis?: [
                number,
                number,
                number
            ] | null;
            /**
             * @description Axis in the frame of body i. The line of `point-on-line` and the normal of `point-in-plane` belong to body i: there
             *     `axis_i` is enough.
             */
            axis_i?: [
                number,
                number,
                number
            ] | null;
            /** @description Axis in the frame of body j. */
            axis_j?: [
                number,
                number,
                number
            ] | null;
            /** @description First body, or `ground` (not for a gear). */
            body_i?: string;
            /** @description Second body, or `ground` (not for a gear). */
            body_j?: string;
            /** @description The two revolute joints that a gear couples. */
            joints?: [
                string,
                string
            ] | null;
            /**
             * Format: double
             * @description Length of a rod, m; without it, the distance of its points at the start.
             */
            length?: number | null;
            /** @description Unique name. */
            name: string;
            /**
             * Format: double
             * @description Angle of a gear's second joint where that of its first is zero, rad; without it, zero.
             */
            offset?: number | null;
            /**
             * Format: double
             * @description Advance of a screw, m a turn; positive for a right-handed thread.
             */
            pitch?: number | null;
            /** @description Common point in the world at the start, m. */
            point?: [
                number,
                number,
                number
            ] | null;
            /** @description Point in the frame of body i, m. */
            point_i?: [
                number,
                number,
                number
            ] | null;
            /** @description Point in the frame of body j, m. */
            point_j?: [
                number,
                number,
                number
            ] | null;
            /** @description Two points in the world at the start, m: the first fixed in body i, the second in body j. */
            points?: [
                [
                    number,
                    number,
                    number
                ],
                [
                    number,
                    number,
                    number
                ]
            ] | null;
            /**
             * Format: double
             * @description Angle of a gear's second joint for each radian of its first.
             */
            ratio?: number | null;
            /** @description Which rows hold the axis of a revolute joint. */
            rows?: components["schemas"]["AxisRows"] | null;
            /** @description Where the joint stands at the start, and how fast it moves there, in place of positions and velocities of bodies. */
            start?: components["schemas"]["JointStart"] | null;
            /**
             * Format: double
             * @description Angle of a revolute joint where the bodies are stated, rad, from which it is counted; without it, zero.
             */
            stated_angle?: number | null;
            /** @description What it is. */
            type: components["schemas"]["JointKind"];
        };
        /** @description What a joint or driver does to a body, in the world. */
        JointForce: {
            /** @description The joint's point, m. */
            at: [
                number,
                number,
                number
            ];
            /** @description The body at the other side, which feels both reversed. */
            by: string;
            /** @description Force, N. */
            force: [
                number,
                number,
                number
            ];
            /** @description The joint or driver. */
            joint: string;
            /** @description Moment about the joint's point, N m. */
            moment: [
                number,
                number,
                number
            ];
            /** @description The body that it acts on: body j, or body i if j is the ground. */
            on: string;
        };
        /** @description What a joint is. */
        JointKind: "spherical" | "revolute" | "universal" | "cylindrical" | "prismatic" | "planar" | "screw" | "fixed" | "rod" | "point-on-line" | "point-in-plane" | "gear";
        /** @description The reaction in one joint. */
        JointMultipliers: {
            /** @description The joint's point in the world, m. */
            at: [
                number,
                number,
                number
            ];
            /** @description The body that exerts it. */
            by: string;
            /** @description The frame of all components. */
            expressed_in: string;
            /** @description Force on the body `on`, N: body j of the joint, or body i if j is the ground. */
            force_on_j: [
                number,
                number,
                number
            ];
            /** @description Name of the joint. */
            joint: string;
            /** @description Moment, N m, about the point `at`. */
            moment_on_j: [
                number,
                number,
                number
            ];
            /** @description The body that the force acts on. */
            on: string;
            /** @description The multipliers of its rows. */
            rows: components["schemas"]["Multiplier"][];
            /**
             * Format: double
             * @description Time of the state, s: the latest that is kept and not after the one that was asked for.
             */
            time: number;
        };
        /**
         * @description Where a joint stands at the start, and how fast it moves. The stated positions of the bodies are those at the angle 0 or at
         *     `stated_angle`; the bodies that hang on the joint are carried from there, and loops are closed with what is given here held.
         */
        JointStart: {
            /**
             * Format: double
             * @description Angle of body j relative to body i about the axis (revolute, cylindrical, screw), rad.
             */
            angle?: number | null;
            /**
             * Format: double
             * @description Rate of the angle, rad/s.
             */
            rate?: number | null;
            /**
             * Format: double
             * @description Displacement along the axis from the joint's point on body i to that on body j (prismatic, cylindrical), m.
             */
            slide?: number | null;
            /**
             * Format: double
             * @description Rate of the displacement, m/s.
             */
            speed?: number | null;
        };
        /** @description Something that was just handed in. */
        JustHanded: {
            /** @description When. */
            at: string;
            /**
             * Format: double
             * @description Points that it earned.
             */
            earned: number;
            /** @description Whether it could be judged. */
            gradable: boolean;
            /** @description The submission. */
            id: string;
            /** @description Slug of the lesson. */
            lesson: string;
            /** @description The name. */
            name: string;
            /** @description The person's id. */
            person: string;
            /**
             * Format: double
             * @description Points that can be earned.
             */
            possible: number;
            /** @description Title of the lesson. */
            title: string;
        };
        /** @description The answer to one question, as it is kept. */
        KeptAnswer: {
            /** @description The id of the option that was chosen. */
            choice?: string | null;
            /** @description The file that was handed in. */
            file?: components["schemas"]["KeptFile"] | null;
            /** @description The settings of a run. */
            settings?: components["schemas"]["RunSettings"] | null;
            /** @description The unit of the value, as typed. */
            unit?: string | null;
            /** @description A number, a list of numbers, or a formula, as typed. */
            value?: components["schemas"]["TypedValue"] | null;
        };
        /** @description A file that was handed in. */
        KeptFile: {
            /**
             * Format: uint
             * @description Its length.
             */
            bytes: number;
        };
        /** @description A submission that is kept, with its verdict. */
        KeptSubmission: {
            /** @description What was handed in, by the question's id. */
            answers: {
                [key: string]: components["schemas"]["KeptAnswer"];
            };
            /**
             * Format: double
             * @description Points earned; left out while they are held back.
             */
            earned?: number | null;
            /** @description False if an answer could not be read or needs more digits: fix it and send again, no attempt is used. */
            gradable: boolean;
            /** @description What is held back: `points`, `messages`. */
            held?: string[];
            /** @description Its name. */
            id: string;
            /** @description Slug of the lesson. */
            lesson: string;
            /** @description Whether the lesson counts as passed: enough points, and nothing left that could not be read. */
            passed?: boolean | null;
            /**
             * Format: double
             * @description Points that can be earned.
             */
            possible: number;
            /** @description What graded it. */
            provenance: components["schemas"]["Provenance"];
            /** @description The questions in the lesson's order. */
            questions: components["schemas"]["ToldQuestion"][];
            /** @description The student. */
            student?: string | null;
            /** @description When it came, RFC 3339 in UTC. */
            submitted_at: string;
        };
        /** @description A driven mechanism at one moment. */
        KinematicState: {
            /** @description Accelerations of their centres of mass, m/s². */
            accelerations: [
                number,
                number,
                number
            ][];
            /** @description Angular accelerations, rad/s². */
            angular_accelerations: [
                number,
                number,
                number
            ][];
            /** @description Positions and velocities of the bodies. */
            bodies: components["schemas"]["BodyFrame"][];
            /** @description What joints and drivers have to exert. */
            reactions: components["schemas"]["ReactionReport"];
            /**
             * Format: double
             * @description Time, s.
             */
            time: number;
        };
        /** @description A driven motion. */
        Kinematics: {
            /**
             * Format: double
             * @description The largest number by which Newton-Raphson has moved an output from where the series lead, m or, of directors, without
             *     a unit: their error. Another branch would be far beyond it.
             */
            correction: number;
            /** @description Events of the scene, in the order of time; one that stops a run ends the motion. */
            events: components["schemas"]["EventOccurrence"][];
            /**
             * Format: uint
             * @description Newton-Raphson steps at the outputs in all.
             */
            iterations: number;
            /** @description What was corrected at the start, or has to be known of the result. */
            notes: string[];
            /** @description Singular positions passed, where other branches begin: the smooth one was taken. */
            passages: components["schemas"]["SingularConfiguration"][];
            /** @description The positions, in the order of time. */
            states: components["schemas"]["KinematicState"][];
            /**
             * Format: uint64
             * @description Steps of the power series from the start to the end.
             */
            steps: number;
        };
        /** @description A step of lateness. */
        LateStep: {
            /**
             * Format: double
             * @description What share of the points counts until then, from 0 to 1.
             */
            share: number;
            /** @description Until when. */
            until: string;
        };
        /** @description What followers are sent in text. */
        LectureMessage: components["schemas"]["LectureState"] | components["schemas"]["SessionState"] | {
            /** @constant */
            type: "reset";
        } | {
            /** @constant */
            type: "closed";
        };
        /** @description A question as everybody sees it. */
        LectureQuestion: {
            /** @description Whether it was asked before: those who have talked it over vote again. */
            again: boolean;
            /** @description What can be answered. */
            choices: string[];
            /**
             * Format: uint64
             * @description Its number.
             */
            number: number;
            /** @description How the answers stand and which is right; nothing before the reveal. */
            result?: components["schemas"]["Tally"] | null;
            /** @description What is asked. */
            text: string;
        };
        /** @description A question of a follower, without a name. */
        LectureRemark: {
            /**
             * Format: uint64
             * @description Its number.
             */
            number: number;
            /** @description Whether the presenter shows it to everybody. */
            shown: boolean;
            /** @description What is asked. */
            text: string;
        };
        /** @description What followers see beside the run. */
        LectureState: {
            /** @description What followers type to join. */
            code: string;
            /**
             * Format: uint64
             * @description How often the presenter has put down all hands: who raised one before puts it down when this grows.
             */
            lowered: number;
            /** @description The question that is asked. */
            question: components["schemas"]["LectureQuestion"] | null;
            /** @description A follower's question that the presenter shows to everybody. */
            remark: components["schemas"]["LectureRemark"] | null;
            /** @description Where the scene came from. */
            source: components["schemas"]["SceneSource"] | null;
            /** @description Title of the scene; nothing while no session is shown. */
            title: string | null;
            /** @description What the presenter looks at, in the page's own words. */
            view: unknown;
        };
        /** @description Something that could not be carried over. */
        LeftOut: {
            /**
             * Format: uint32
             * @description Its line in the URDF.
             */
            line: number;
            /** @description What it belongs to, such as `joint elbow`. */
            of: string;
            /** @description What is missing, and what it means. */
            what: string;
        };
        /** @description A lesson as a student sees it. */
        Lesson: {
            /** @description The questions. */
            exercise: components["schemas"]["Exercise"];
            /** @description Whether each student gets numbers, or states, of their own. */
            has_variants: boolean;
            /** @description The text as safe HTML. */
            html: string;
            /** @description Notions that it introduces. */
            introduces: string[];
            /**
             * Format: uint32
             * @description Time a student needs.
             */
            minutes: number;
            /** @description Notions that it builds on. */
            needs: string[];
            /**
             * Format: uint32
             * @description Place in the course, from 1.
             */
            number: number;
            /** @description What the student can do afterwards. */
            objectives: string[];
            /** @description Title of the part of the course that it stands in. */
            part?: string | null;
            /** @description What is predicted before the scenario runs; may be empty. */
            predictions: components["schemas"]["Prediction"][];
            /** @description Slugs of the lessons that come before. */
            prerequisites: string[];
            /** @description The scenario. */
            scene: components["schemas"]["Scene"];
            /** @description Whose numbers these are; empty for those that everybody sees without a name. */
            seed: string;
            /** @description Stable name for addresses. */
            slug: string;
            /** @description Predict, run, check, explain; may be empty. */
            steps: components["schemas"]["LessonStep"][];
            /** @description One sentence. */
            summary: string;
            /** @description Title. */
            title: string;
        };
        /** @description The questions of a lesson in figures. */
        LessonFigures: {
            /**
             * Format: uint32
             * @description Its place in the course.
             */
            number: number;
            /** @description The questions, in the order of the lesson. */
            questions: components["schemas"]["QuestionFigures"][];
            /** @description Slug of the lesson. */
            slug: string;
            /**
             * Format: uint
             * @description Students who handed in.
             */
            students: number;
            /** @description Its title. */
            title: string;
        };
        /** @description The lessons of a course. */
        LessonList: components["schemas"]["LessonSummary"][];
        /** @description One person's work in one lesson. */
        LessonRecord: {
            /** @description Whether the student's request for a look again waits for an answer. */
            asked: boolean;
            /** @description What is allowed beyond the others. */
            extension?: components["schemas"]["Extension"] | null;
            /** @description What it counts after the due date, for this person. */
            late?: components["schemas"]["LateStep"][];
            /**
             * Format: uint32
             * @description Its place in the course.
             */
            number: number;
            /** @description From when it can be handed in. */
            opens?: string | null;
            /**
             * Format: double
             * @description Points that can be earned.
             */
            possible: number;
            /** @description Regrades that changed something here, the latest first. */
            regrades: components["schemas"]["RegradeNote"][];
            /** @description What was decided and said, the first at the beginning. */
            remarks: components["schemas"]["Remark"][];
            /** @description Slug of the lesson. */
            slug: string;
            /** @description Where the person stands. */
            standing: components["schemas"]["ToldStanding"];
            /** @description Its title. */
            title: string;
        };
        /** @description A step as a student sees it. */
        LessonStep: {
            /** @description The step as safe HTML. */
            html: string;
            /** @description What to do here. */
            kind: components["schemas"]["StepKind"];
        };
        /** @description A lesson in the list of lessons. */
        LessonSummary: {
            /** @description Notions that it introduces. */
            introduces: string[];
            /**
             * Format: uint32
             * @description Time a student needs.
             */
            minutes: number;
            /** @description Notions that it builds on. */
            needs: string[];
            /**
             * Format: uint32
             * @description Place in the course, from 1.
             */
            number: number;
            /** @description What the student can do afterwards. */
            objectives: string[];
            /** @description Title of the part of the course that it stands in. */
            part?: string | null;
            /** @description Stable name for addresses. */
            slug: string;
            /** @description One sentence. */
            summary: string;
            /** @description Title. */
            title: string;
        };
        /** @description Where to go from here. */
        Links: {
            /** @description Its Jacobian. */
            jacobian: string;
            /** @description Its multipliers. */
            multipliers: string;
            /** @description Its scene as it is now. */
            scene: string;
            /** @description This session. */
            self: string;
            /** @description Its stream: a WebSocket. */
            stream: string;
        };
        /** @description A force or moment besides gravity. */
        Load: {
            /** @description The body. */
            body: string;
            /** @description The force, N. */
            force: components["schemas"]["VectorMotion"];
            /**
             * @description Frame of the force.
             * @default world
             */
            frame?: components["schemas"]["LoadFrame"];
            /** @description Unique name. */
            name: string;
            /**
             * @description The point in the body's frame, m.
             * @default [
             *       0,
             *       0,
             *       0
             *     ]
             */
            point?: [
                number,
                number,
                number
            ];
            /** @constant */
            type: "force";
        } | {
            /** @description The body. */
            body: string;
            /**
             * @description Frame of the moment.
             * @default world
             */
            frame?: components["schemas"]["LoadFrame"];
            /** @description The moment, N m. */
            moment: components["schemas"]["VectorMotion"];
            /** @description Unique name. */
            name: string;
            /** @constant */
            type: "moment";
        } | {
            /** @description First body, or `ground`. */
            body_i: string;
            /** @description Second body, or `ground`. */
            body_j: string;
            /**
             * Format: double
             * @description Damping, N s/m.
             * @default 0
             */
            damping?: number;
            /** @description Pull of the actuator, N. */
            force?: components["schemas"]["Motion"] | null;
            /**
             * Format: double
             * @description Length without force, m; without it, the length at the start.
             */
            free_length?: number | null;
            /** @description Unique name. */
            name: string;
            /** @description Point in the frame of body i, m. */
            point_i: [
                number,
                number,
                number
            ];
            /** @description Point in the frame of body j, m. */
            point_j: [
                number,
                number,
                number
            ];
            /**
             * Format: double
             * @description Stiffness, N/m.
             * @default 0
             */
            stiffness?: number;
            /** @constant */
            type: "spring";
        } | {
            /**
             * Format: double
             * @description Damping, N m s/rad.
             * @default 0
             */
            damping?: number;
            /**
             * Format: double
             * @description Angle without moment, rad.
             * @default 0
             */
            free_angle?: number;
            /** @description Friction. */
            friction?: components["schemas"]["Friction"] | null;
            /** @description The joint. */
            joint: string;
            /** @description Unique name. */
            name: string;
            /**
             * Format: double
             * @description Stiffness, N m/rad.
             * @default 0
             */
            stiffness?: number;
            /** @description Torque of the motor, N m. */
            torque?: components["schemas"]["Motion"] | null;
            /** @constant */
            type: "torsion";
        } | {
            /**
             * Format: double
             * @description Damping, N s/m.
             * @default 0
             */
            damping?: number;
            /** @description Force of the actuator, N. */
            force?: components["schemas"]["Motion"] | null;
            /**
             * Format: double
             * @description Displacement without force, m.
             * @default 0
             */
            free_length?: number;
            /** @description Friction. */
            friction?: components["schemas"]["Friction"] | null;
            /** @description The joint. */
            joint: string;
            /** @description Unique name. */
            name: string;
            /**
             * Format: double
             * @description Stiffness, N/m.
             * @default 0
             */
            stiffness?: number;
            /** @constant */
            type: "slider";
        };
        /** @description The frame in which a force or a moment is given. */
        LoadFrame: "world" | "body";
        /** @description How one answer was judged. */
        Mark: "right" | "wrong" | "blank" | "invalid" | "kept" | "waiting";
        /** @description What somebody who teaches gave an explanation. */
        Marked: {
            /** @description When. */
            at: string;
            /** @description By whom. */
            by: string;
            /**
             * Format: double
             * @description The points; none where an earlier mark was taken back.
             */
            points?: number | null;
            /** @description The question. */
            question: string;
            /** @description What was remarked; may be empty. */
            remark: string;
        };
        /** @description A point of a body that has a name: tables, pictures and events know where it is. It has no influence on the motion. */
        Marker: {
            /** @description The body, or `ground`. */
            body: string;
            /** @description Unique name among the markers. */
            name: string;
            /** @description The point in the body's frame, m; its reference point if it is left out. */
            point?: [
                number,
                number,
                number
            ];
        };
        /** @description What stands at a place of a symmetric matrix. */
        MatrixPart: "own" | "constant" | "changing" | "fill";
        /** @description How this server is used, and by whom. */
        Me: {
            /** @description Title of the class. */
            course?: string | null;
            /** @description Signing in with the account of an institution, where the server knows its provider. */
            institution?: components["schemas"]["Institution"] | null;
            /** @description Whether students may join now. */
            join_open: boolean;
            /** @description `home`: no accounts, grades are for oneself; `class`: with accounts. */
            mode: string;
            /** @description Who is signed in. */
            person?: components["schemas"]["Somebody"] | null;
        };
        /** @description A mistake with the answers behind it. */
        MistakeAnswers: {
            /** @description The answers, by name. */
            answers: components["schemas"]["GivenAnswer"][];
            /** @description Its name; empty: not recognised. */
            name: string;
            /**
             * Format: uint
             * @description Students whose last answer still has it.
             */
            still: number;
            /**
             * Format: uint
             * @description Students who made it at least once.
             */
            students: number;
            /** @description What the first of them was told, as safe HTML. */
            told_html: string;
        };
        /** @description A mistake and how many made it. */
        MistakeCount: {
            /** @description Its name; empty: not recognised. */
            name: string;
            /**
             * Format: uint
             * @description Students whose last answer still has it.
             */
            still: number;
            /**
             * Format: uint
             * @description Students who made it at least once.
             */
            students: number;
        };
        /** @description One mode, moving as e^(λt). */
        Mode: {
            /**
             * Format: double
             * @description Part of critical damping.
             */
            damping_ratio: number;
            /**
             * Format: double
             * @description Estimated error of λ = growth + 2π i frequency, 1/s: how far it moves with the position, by what that may be off, and with the
             *     differences of which the linear equations are made. `None` where it drifts, and where it is not known.
             */
            error: number | null;
            /**
             * Format: double
             * @description Frequency, Hz.
             */
            frequency: number;
            /**
             * Format: double
             * @description Real part of λ, 1/s: negative where the motion dies away.
             */
            growth: number;
            /** @description What it does, in a word: `oscillates`, `decays`, `grows` or `drifts`. */
            kind: string;
            /**
             * @description The motion of each body. The component of displacement (m, or rad times the mechanism's length) with the largest amplitude, the
             *     first of equal ones, is one now and zero a quarter of a period from now: this fixes size, sign and phase.
             */
            shape: components["schemas"]["ModeShape"][];
        };
        /** @description The part of a mode that one body takes. */
        ModeShape: {
            /** @description Rotation vector at that time, rad. */
            rotation: [
                number,
                number,
                number
            ];
            /** @description Rotation vector then, rad. */
            rotation_later: [
                number,
                number,
                number
            ];
            /**
             * @description Displacement of the centre of mass at the time at which the largest of all is at its peak, m, in the world's axes or, about a
             *     steady motion, along those of its frame.
             */
            translation: [
                number,
                number,
                number
            ];
            /** @description Displacement a quarter of a period later but for growth and decay, zero where all bodies move in phase, m. */
            translation_later: [
                number,
                number,
                number
            ];
        };
        /** @description All modes of a position. */
        Modes: {
            /** @description The bodies at that position. */
            bodies: components["schemas"]["BodyFrame"][];
            /**
             * Format: uint
             * @description Degrees of freedom.
             */
            freedoms: number;
            /**
             * Format: uint
             * @description Degrees of freedom that have no inertia, and neither stiffness nor damping: they have no mode.
             */
            left_out: number;
            /** @description The modes, slowest first; those without a frequency by their growth. */
            modes: components["schemas"]["Mode"][];
            /** @description What has to be known of the result. */
            notes: string[];
            /** @description The steady motion, if the modes are about one. */
            steady?: components["schemas"]["SteadyMotion"] | null;
            /** @description The bodies that turn in those, and their axes. */
            without_inertia: components["schemas"]["TurnsWithoutInertia"][];
        };
        /** @description The position about which the motion is linearized. */
        ModesAbout: "equilibrium" | "start" | "steady";
        /** @description The point about which moments are taken. */
        MomentPoint: "joint" | "center";
        /** @description A number as a function of time t: one of the kinds of motion, or a plain number, which is constant. */
        Motion: {
            /** @constant */
            kind: "constant";
            /**
             * Format: double
             * @description The value.
             */
            value: number;
        } | {
            /** @constant */
            kind: "ramp";
            /**
             * Format: double
             * @description Change in a second.
             */
            rate: number;
            /**
             * Format: double
             * @description Value at t = 0.
             * @default 0
             */
            start?: number;
        } | {
            /** @description c₀, c₁, …; at most 32. */
            coefficients: number[];
            /** @constant */
            kind: "polynomial";
        } | {
            /**
             * Format: double
             * @description Greatest deviation from the mean.
             */
            amplitude: number;
            /**
             * Format: double
             * @description Angular frequency, rad/s.
             */
            frequency: number;
            /** @constant */
            kind: "harmonic";
            /**
             * Format: double
             * @description Value about which it swings.
             * @default 0
             */
            mean?: number;
            /**
             * Format: double
             * @description Phase at t = 0, rad.
             * @default 0
             */
            phase?: number;
        } | {
            /**
             * Format: double
             * @description Time at which it has reached the second value, s.
             */
            end: number;
            /**
             * Format: double
             * @description Value until `start`.
             */
            from: number;
            /** @constant */
            kind: "smooth-step";
            /**
             * Format: double
             * @description Time at which it leaves the first value, s.
             */
            start: number;
            /**
             * Format: double
             * @description Value after `end`.
             */
            to: number;
        } | {
            /** @constant */
            kind: "table";
            /** @description Times, s, increasing; at least two, at most 10 000. */
            times: number[];
            /** @description Values at those times. */
            values: number[];
        } | {
            /** @constant */
            kind: "expression";
            /** @description The formula: numbers, t, pi, + - * / ^, brackets, and sin, cos, tan, asin, acos, atan, sqrt, exp, ln. */
            value: string;
        } | number;
        /** @description A joint of a recorded run. */
        MotionJoint: {
            /** @description The body at the other side. */
            by: string;
            /** @description The joint or driver. */
            joint: string;
            /** @description The body that its reaction acts on. */
            on: string;
        };
        /** @description One multiplier λ of eq. (6.6) with the label of its equation. */
        Multiplier: {
            /** @description Label of the equation within its joint. */
            label: string;
            /**
             * Format: double
             * @description λ, in N for a row in metres, in N m for a row of unit vectors.
             */
            value: number;
        };
        /** @description The multipliers of all joints. */
        MultipliersList: components["schemas"]["JointMultipliers"][];
        /** @description A notion that a lesson builds on. */
        Need: {
            /** @description Slug of the lesson that introduces it, taken or not; none if students bring it along, or nothing does. */
            from?: string | null;
            /** @description Whether it is known by then: brought along, or introduced by an earlier lesson of the course. */
            met: boolean;
            /** @description The notion. */
            notion: string;
        };
        /** @description Where the camera is to stand. */
        NewCamera: {
            /** @description From where the mechanism is looked at. */
            from: components["schemas"]["Camera"];
        };
        /** @description A decision about a grade. */
        NewDecision: {
            /** @description Slug of the lesson. */
            lesson: string;
            /**
             * Format: double
             * @description The points that count from now on; null: those that were earned, and an explanation waits again.
             */
            points?: number | null;
            /**
             * @description The explanation that gets the points; left out: the whole lesson.
             * @default null
             */
            question?: string | null;
            /** @description Why: the student sees it, and so does whoever looks later. May be empty for an explanation. */
            reason: string;
        };
        /** @description How forces are to be drawn; what is not given stays. */
        NewDrawing: {
            /** @description Which, on which body, about which point. */
            arrows?: components["schemas"]["Arrows"] | null;
            /**
             * @description Take the scale of forces from the recording so far.
             * @default false
             */
            fit?: boolean;
        };
        /** @description More time or attempts for one person. What is left out stays as it was. */
        NewExtension: {
            /**
             * Format: uint32
             * @description Attempts beyond those of everybody; 0 leaves them as they were, null takes them away.
             */
            attempts?: number | null;
            /** @description Why. */
            reason: string;
            /** @description Until when it counts in full; late steps and the end follow at the same distance. Null takes it away. */
            until?: string | null;
        };
        /** @description The session that a lecture shows. */
        NewLecture: {
            /**
             * @description The room's name, for an address that stays the same: 7 to 40 letters a to z and digits, with single hyphens between. It
             *     belongs to who opens it first; they open it again, and go on with a lecture that is open under it.
             * @default null
             * @example mbs-2026
             */
            name?: string | null;
            /**
             * @description At home, where nobody has an account: what shows later that the name is one's own. Long and hard to guess.
             * @default null
             */
            secret?: string | null;
            /** @description Its id; who knows it may show it. */
            session: string;
        };
        /** @description What the presenter shows. */
        NewLectureView: {
            /** @description Another session than before. */
            session?: string | null;
            /** @description Time, selection and panels in the page's own words. */
            view?: unknown;
        };
        /** @description A question to be asked. */
        NewQuestion: {
            /** @description What can be answered, two to eight choices. */
            choices: string[];
            /**
             * Format: uint
             * @description The choice that is right, as an index, if one is; a secret before the reveal.
             * @default null
             */
            right?: number | null;
            /**
             * @description What is asked.
             * @example Which sign has Fx of the pin at this moment?
             */
            text: string;
        };
        /** @description A question of a follower, to be asked. */
        NewRemark: {
            /**
             * @description What is asked; nobody is told by whom.
             * @example Why is the multiplier negative here?
             */
            text: string;
            /** @description A name that the follower's browser made up: it bounds how often one asks, and is told to nobody. */
            voter: string;
        };
        /** @description A role. */
        NewRole: {
            /** @description `student`, `grader`, `instructor` or `owner`. */
            role: string;
        };
        /** @description What to simulate: exactly one of `lesson`, `builtin` and `scene`. */
        NewSession: {
            /**
             * @description A built-in scene, by name.
             * @example n-four-bar:2
             */
            builtin?: string | null;
            /** @description Changes that are made before the start; undoing them leads back to the scene as it is written. */
            change?: components["schemas"]["SceneChange"];
            /** @description The scenario of a lesson, by the lesson's slug. */
            lesson?: string | null;
            /** @description Settings that replace those of the scene. */
            overrides?: components["schemas"]["Overrides"];
            /** @description A scene; its schema is at /api/v1/schema/scene. */
            scene?: components["schemas"]["Scene"] | null;
            /** @description With `lesson`: whose numbers, a student's name or another seed; without it, those that everybody sees. */
            seed?: string | null;
        };
        /** @description Words and link of somebody who lost theirs. */
        NewWords: {
            /** @description The secret of the link `/return#…`. */
            link: string;
            /** @description Four words. */
            words: string;
        };
        /** @description What each lesson of a course introduces and needs, in the course's order. */
        NotionGraph: {
            /** @description Notions that students bring along. */
            assumes: string[];
            /** @description The lessons in order. */
            lessons: components["schemas"]["NotionNode"][];
            /** @description When the right answer to a question is shown. */
            opens: components["schemas"]["OpensFile"];
            /** @description Lessons that are at hand and not taken. */
            others: components["schemas"]["NotionNode"][];
            /** @description Title of the course. */
            title: string;
        };
        /** @description A lesson in the graph. */
        NotionNode: {
            /** @description Notions that it introduces. */
            introduces: string[];
            /**
             * Format: uint32
             * @description How long a student needs, in minutes.
             */
            minutes: number;
            /** @description Notions that it builds on. */
            needs: components["schemas"]["Need"][];
            /**
             * Format: uint32
             * @description Its place.
             */
            number: number;
            /** @description Title of the part of the course that it stands in. */
            part?: string | null;
            /** @description Slug of the lesson. */
            slug: string;
            /** @description Its title. */
            title: string;
        };
        /** @description What stands at a place of a scene that may be changed. */
        NumberOrWord: number | string;
        /** @description What happens to a run when a parameter changes. */
        OnChange: "restart" | "continue";
        /** @description A room that was opened. */
        OpenedLecture: {
            /** @description What followers type to join. */
            code: string;
            /** @description Shows that somebody is the presenter: to be sent as `authorization: Bearer KEY`. It is sent only here. */
            key: string;
            /** @description Where followers go, below the server's address. */
            page: string;
        };
        /**
         * @description When the right answer to a question and its source are shown to a student, whichever comes first. From then on the points
         *     of the question are what they were before.
         */
        OpensFile: {
            /**
             * Format: uint
             * @description After so many different answers to it, right or wrong.
             * @default null
             */
            attempts: number | null;
            /**
             * Format: uint
             * @description The same for a choice; it opens at the latest when one option is left.
             * @default null
             */
            choices: number | null;
            /**
             * @description When it has been answered right.
             * @default false
             */
            right: boolean;
        };
        /** @description Orientation of a body's frame in the world. */
        Orientation: {
            /**
             * Format: double
             * @description Angle of the rotation about `axis`, rad.
             */
            angle?: number | null;
            /** @description Axis of a rotation (with `angle`). */
            axis?: [
                number,
                number,
                number
            ] | null;
            /** @description Unit quaternion, scalar first, body to world. */
            quaternion?: [
                number,
                number,
                number,
                number
            ] | null;
            /** @description First director u (with `v`); made orthonormal if it is nearly so. */
            u?: [
                number,
                number,
                number
            ] | null;
            /** @description Second director v (with `u`). */
            v?: [
                number,
                number,
                number
            ] | null;
            /** @description Third director w, if it is stated: then it must be u × v. */
            w?: [
                number,
                number,
                number
            ] | null;
        };
        /** @description A column with other points than its lesson. */
        OtherPoints: {
            /** @description The column's title. */
            column: string;
            /**
             * Format: double
             * @description Points that can be earned in the lesson.
             */
            here: number;
            /**
             * Format: double
             * @description Points that can be earned by it in Canvas.
             */
            there: number;
        };
        /** @description What came of a prediction. */
        Outcome: {
            /** @description Id of the option that comes true. */
            happens: string;
            /** @description What the run shows, and why, as safe HTML. */
            html: string;
        };
        /** @description A group of columns: bodies, frames, accelerations, reactions, drivers, joints, loads, markers, energy, balance, violations, errors; of one element alone with its name behind a colon, like reactions:pin. */
        Output: string;
        /** @description Settings that replace those of the scene. */
        Overrides: {
            /**
             * Format: double
             * @description End of the simulation, s.
             * @default null
             */
            duration?: number | null;
            /**
             * Format: double
             * @description Time between frames, s.
             * @default null
             */
            every?: number | null;
            /**
             * @description How the constraints are kept.
             * @default null
             */
            stabilization?: components["schemas"]["Stabilization"] | null;
            /**
             * Format: double
             * @description Tolerance of the integrator.
             * @default null
             */
            tolerance?: number | null;
        };
        /** @description Everything that is kept of who asks. */
        OwnData: {
            /** @description The class. */
            course: string;
            /** @description What was decided about their grades, and why. */
            decisions: components["schemas"]["OwnDecision"][];
            /**
             * Format: int64
             * @description When they joined, in milliseconds since 1970.
             */
            joined_at: number;
            /** @description What the log knows of them. */
            log: components["schemas"]["OwnEvent"][];
            /** @description Who. */
            person: components["schemas"]["Somebody"];
            /** @description What they predicted before runs. */
            predictions: components["schemas"]["OwnPrediction"][];
            /** @description What they handed in, files included, with the verdicts, newest first. */
            submissions: components["schemas"]["OwnSubmission"][];
        };
        /** @description A decision about a grade. */
        OwnDecision: {
            /** @description When. */
            at: string;
            /** @description Slug of the lesson. */
            lesson: string;
            /**
             * Format: double
             * @description The points that count; null: those that were earned.
             */
            points: number | null;
            /** @description The explanation that it is about; null: the whole lesson. */
            question: string | null;
            /** @description Why. */
            reason: string;
        };
        /** @description An entry of the log that somebody made, or that is about them. */
        OwnEvent: {
            /**
             * Format: int64
             * @description When, in milliseconds since 1970.
             */
            at: number;
            /** @description Whether they did it themselves. */
            own: boolean;
            /** @description A verb in the past tense. */
            what: string;
        };
        /** @description A prediction. */
        OwnPrediction: {
            /**
             * Format: int64
             * @description When, in milliseconds since 1970.
             */
            at: number;
            /** @description Id of the option; null: it was skipped. */
            choice: string | null;
            /** @description Slug of the lesson. */
            lesson: string;
            /** @description Id of the prediction. */
            prediction: string;
            /** @description Why, in their words. */
            why: string;
        };
        /** @description A run of one's own. */
        OwnRun: {
            /** @description The scene as it is to be run; its schema is at /api/v1/schema/scene. */
            scene: components["schemas"]["Scene"];
        };
        /** @description A submission with its verdict. */
        OwnSubmission: {
            /** @description What was handed in. */
            answers: unknown;
            /** @description What was told of it. */
            verdict: unknown;
        };
        /** @description A number of the scene that the author offers to be changed while it runs. */
        Parameter: {
            /**
             * Format: double
             * @description Greatest value.
             */
            high: number;
            /** @description Name for people. */
            label: string;
            /**
             * Format: double
             * @description Least value.
             */
            low: number;
            /** @description Unique name, used in addresses. */
            name: string;
            /**
             * @description What happens to a run whose value is changed.
             * @default restart
             */
            on_change?: components["schemas"]["OnChange"];
            /** @description Where its number stands in the scene; several places if they change together. */
            pointer: components["schemas"]["Places"];
            /**
             * Format: double
             * @description Between two values of a slider.
             */
            step?: number | null;
            /** @description Unit, for people. */
            unit?: string | null;
        };
        /** @description In which direction a number passes a value. */
        Passing: "either" | "upwards" | "downwards";
        /** @description People of the class, by name. */
        PeopleList: components["schemas"]["Somebody"][];
        /** @description What changes for a person. */
        PersonChange: {
            /**
             * Format: double
             * @description Points that count, after: attempts and lateness counted anew.
             */
            after: number;
            /** @description Attempts before and after. */
            attempts: [
                number,
                number
            ];
            /**
             * Format: double
             * @description Points that count, before.
             */
            before: number;
            /** @description The name. */
            name: string;
            /** @description Whether the lesson is passed, before and after: with the mark of the lesson that graded, and with the new one. */
            passed: [
                boolean,
                boolean
            ];
            /** @description The person's id. */
            person: string;
            /** @description What changes for each submission; those that stay the same are left out. */
            submissions: components["schemas"]["SubmissionChange"][];
        };
        /** @description An extension and whose it is. */
        PersonExtension: {
            /** @description When. */
            at: string;
            /**
             * Format: uint32
             * @description Attempts beyond those of everybody.
             */
            attempts: number;
            /** @description Who gave it. */
            by: string;
            /** @description The person's id. */
            person: string;
            /** @description Why. */
            reason: string;
            /** @description Until when it counts in full; late steps and the end follow at the same distance. */
            until?: string | null;
        };
        /** @description Whether an exercise can be handed in. */
        Phase: "not_open" | "open" | "late" | "practice" | "closed";
        /** @description The scenes at their starts: what a list of them shows. */
        Pictures: {
            /** @description Of the lessons, by their slugs. */
            lessons: {
                [key: string]: components["schemas"]["RecordedMotion"];
            };
            /** @description Of the built-in scenes, by the names to run them by. */
            scenes: {
                [key: string]: components["schemas"]["RecordedMotion"];
            };
        };
        /** @description A place in the scene. */
        Place: string | {
            /**
             * Format: double
             * @description The number there is the parameter times this factor.
             */
            factor: number;
            /** @description A JSON pointer. */
            pointer: string;
        };
        /** @description A body's place after assembly, in the terms in which its author writes it. */
        Placement: {
            /** @description Angular velocity in the world, rad/s. */
            angular_velocity: [
                number,
                number,
                number
            ];
            /** @description The body. */
            body: string;
            /**
             * Format: double
             * @description How far its centre of mass was moved, m.
             */
            moved: number;
            /** @description Position of its reference point, m. */
            position: [
                number,
                number,
                number
            ];
            /** @description Orientation of its frame, unit quaternion with the scalar first. */
            quaternion: [
                number,
                number,
                number,
                number
            ];
            /**
             * Format: double
             * @description How far it was turned, rad.
             */
            turned: number;
            /** @description Velocity of its reference point, m/s. */
            velocity: [
                number,
                number,
                number
            ];
        };
        /** @description One place or several. */
        Places: components["schemas"]["Place"] | components["schemas"]["Place"][];
        /** @description The learning platforms of the class. */
        PlatformList: {
            /** @description Those that are registered. */
            platforms: components["schemas"]["PlatformView"][];
            /** @description Whether this server is reached by learning platforms at all. */
            reached: boolean;
        };
        /** @description A learning platform. */
        PlatformView: {
            /** @description Where scores go. */
            columns: components["schemas"]["ColumnView"][];
            /** @description Its courses whose people come into the class. */
            courses: components["schemas"]["CourseView"][];
            /** @description What it calls itself. */
            issuer: string;
            /** @description Until when nothing is asked of it, as it did not answer. */
            paused_until?: string | null;
            /** @description What it did instead; empty if all is well. */
            problem: string;
        };
        /** @description How fast to play. */
        PlayRequest: {
            /**
             * Format: double
             * @description Simulated seconds a second, 0.001 to 1000; 1 if it is not given.
             */
            speed?: number | null;
        };
        /** @description How an exercise is handed in. What is left out bounds nothing. */
        Policy: {
            /** @description Until when it can be handed in at all. */
            closes?: string | null;
            /**
             * Format: uint32
             * @description Minutes between an attempt and the next.
             * @default 0
             */
            cooldown_minutes?: number;
            /** @description Until when it counts in full. */
            due?: string | null;
            /** @description What share of its points the first, second, … attempt counts, from 0 to 1; the last holds for all that follow. */
            falling?: number[];
            /** @description What it counts after that, step by step; after the last it earns nothing, and is practice. */
            late?: components["schemas"]["LateStep"][];
            /**
             * Format: uint32
             * @description Attempts that each person has.
             */
            most_attempts?: number | null;
            /** @description From when it can be handed in. */
            opens?: string | null;
            /**
             * @description What students are told of a verdict, and when.
             * @default {
             *       "messages": "at_once",
             *       "points": "at_once",
             *       "reference": "at_once"
             *     }
             */
            reveal?: components["schemas"]["Reveal"];
        };
        /** @description What a policy makes of a person's work. */
        PolicyPreview: {
            /** @description At what moment. */
            at: string;
            /** @description Where the person then stands. */
            standing: components["schemas"]["Standing"];
            /** @description The person's last submission by then, as it would be told; left out if there is none. */
            told?: components["schemas"]["GradedSubmission"] | null;
        };
        /** @description A prediction to keep. */
        Predicted: {
            /**
             * @description Id of the option; null or left out: none is made, and that is kept, too.
             * @default null
             */
            choice?: string | null;
            /** @description Id of the prediction. */
            prediction: string;
            /** @description Who predicts, at home; in a class it is the caller. */
            student?: string | null;
            /**
             * @description Why, in a sentence.
             * @default
             */
            why?: string;
        };
        /** @description Something to predict before the run. */
        Prediction: {
            /** @description Whether a sentence why is asked for, too. */
            asks_why: boolean;
            /** @description What is asked, as safe HTML. */
            html: string;
            /** @description Id under which the prediction is sent. */
            id: string;
            /** @description What may happen. */
            options: components["schemas"]["ChoiceOption"][];
            /**
             * Format: double
             * @description Points for having predicted, right or wrong.
             */
            points: number;
            /**
             * Format: double
             * @description When the run has shown what happens, s.
             */
            seen_at: number;
            /** @description Parameters of the scene to set before the run, by name. */
            with?: {
                [key: string]: number;
            };
        };
        /** @description How often what was predicted. */
        PredictionCounts: {
            /** @description Whether a sentence why is asked for, too. */
            asks_why: boolean;
            /** @description How many chose each option, in the order of the options. */
            chosen: number[];
            /** @description Id of the option that comes true. */
            happens: string;
            /** @description What is asked, as safe HTML. */
            html: string;
            /** @description Id under which the prediction is sent. */
            id: string;
            /**
             * Format: uint
             * @description How many have neither predicted nor skipped.
             */
            missing: number;
            /** @description What may happen. */
            options: components["schemas"]["ChoiceOption"][];
            /**
             * Format: double
             * @description Points for having predicted, right or wrong.
             */
            points: number;
            /** @description The sentences why. */
            reasons: components["schemas"]["Reason"][];
            /**
             * Format: double
             * @description When the run has shown what happens, s.
             */
            seen_at: number;
            /**
             * Format: uint
             * @description How many skipped it.
             */
            skipped: number;
            /** @description Parameters of the scene to set before the run, by name. */
            with?: {
                [key: string]: number;
            };
        };
        /** @description What was predicted in a lesson. */
        PredictionTable: components["schemas"]["PredictionCounts"][];
        /** @description What a follower tells over its stream, as text: it counts for as long as the stream is open. */
        Presence: {
            /**
             * @description Raises a hand.
             * @default false
             */
            hand?: boolean;
            /**
             * @description Looks around alone, not at what the presenter shows.
             * @default false
             */
            roaming?: boolean;
            /**
             * @description Is no follower but the projector's window.
             * @default false
             */
            screen?: boolean;
        };
        /** @description Somebody who is here. */
        Present: {
            /** @description When they last did something. */
            at: string;
            /** @description The name. */
            name: string;
            /** @description The person's id. */
            person: string;
            /** @description Whether they are stuck in this lesson. */
            stuck: boolean;
        };
        /** @description What only the presenter sees. */
        PresenterState: {
            /**
             * Format: uint
             * @description How many follow now.
             */
            followers: number;
            /**
             * Format: uint
             * @description How many raise a hand.
             */
            hands: number;
            /** @description The question that is asked, as followers see it. */
            question: components["schemas"]["LectureQuestion"] | null;
            /** @description Questions of followers that wait, the oldest first; nobody is told by whom. */
            remarks: components["schemas"]["LectureRemark"][];
            /**
             * Format: uint
             * @description How many followers look around on their own.
             */
            roaming: number;
            /**
             * Format: uint
             * @description How many windows show the lecture to the hall: the presenter's own page is then seen by the presenter alone.
             */
            screens: number;
            /** @description How the answers stand. */
            tally: components["schemas"]["Tally"] | null;
        };
        /** @description What a regrade would change. */
        Preview: {
            /** @description How many came out how. */
            counts: components["schemas"]["Counts"];
            /** @description The same after. */
            histogram_after: number[];
            /** @description How many people reach which tenth of the points, before. */
            histogram_before: number[];
            /** @description Its name, to apply it by. */
            id: string;
            /** @description Slug of the lesson. */
            lesson: string;
            /**
             * Format: uint
             * @description How many of them another version of the lesson had graded.
             */
            of_other_versions: number;
            /** @description People for whom something changes, by name. */
            people: components["schemas"]["PersonChange"][];
            /**
             * Format: double
             * @description How long it took, in seconds.
             */
            seconds: number;
            /**
             * Format: uint
             * @description Submissions that were graded again.
             */
            submissions: number;
        };
        /** @description What to look at before it counts. */
        PreviewRequest: {
            /**
             * @description At what moment; now if it is left out.
             * @default null
             */
            at?: string | null;
            /**
             * @description The person's id; without it somebody who has handed in nothing.
             * @default null
             */
            person?: string | null;
            /**
             * @description The policy; without it the one that holds.
             * @default null
             */
            policy?: components["schemas"]["Policy"] | null;
        };
        /** @description The members of a problem document as they go over the wire. */
        Problem: {
            /**
             * @description The stable name of this kind of problem.
             * @example unknown-lesson
             */
            code: string;
            /** @description What happened this time. */
            detail: string;
            /** @description The places in the input that are wrong; empty if the problem is not about the input. */
            errors: components["schemas"]["Fault"][];
            /** @description What to try. */
            hint: string;
            /**
             * Format: uint16
             * @description The HTTP status, repeated.
             */
            status: number;
            /** @description A short summary, the same for every problem of this kind. */
            title: string;
            /** @description Names the request, to be quoted in a report; the header `x-request-id` and the server's log have the same. */
            trace_id: string;
            /**
             * @description A stable name for this kind of problem, as a URI.
             * @example urn:triad:problem:unknown-lesson
             */
            type: string;
        };
        /** @description What graded a submission, so that a grade can be traced and repeated. */
        Provenance: {
            /** @description Version of the engine and of the grader. */
            engine: string;
            /** @description Fingerprint of every file of the lesson (64-bit FNV-1a, hexadecimal). */
            lesson_hash: string;
            /**
             * @description The numbers that were drawn.
             * @default {}
             */
            parameters: {
                [key: string]: number;
            };
            /**
             * @description Seed of the numbers and states; empty for those that everybody sees.
             * @default
             */
            seed: string;
        };
        /** @description A number that changes with the motion. */
        Quantity: {
            /** @description The body. */
            body: string;
            /** @description The direction; made a unit vector. */
            direction: [
                number,
                number,
                number
            ];
            /**
             * @description The point in the body's frame, m.
             * @default [
             *       0,
             *       0,
             *       0
             *     ]
             */
            point?: [
                number,
                number,
                number
            ];
            /** @constant */
            type: "coordinate";
        } | {
            /** @description The direction; made a unit vector. */
            direction: [
                number,
                number,
                number
            ];
            /** @description The marker. */
            marker: string;
            /** @constant */
            type: "marker";
        } | {
            /** @description First body, or `ground`. */
            body_i: string;
            /** @description Second body, or `ground`. */
            body_j: string;
            /**
             * @description Point in the frame of body i, m.
             * @default [
             *       0,
             *       0,
             *       0
             *     ]
             */
            point_i?: [
                number,
                number,
                number
            ];
            /**
             * @description Point in the frame of body j, m.
             * @default [
             *       0,
             *       0,
             *       0
             *     ]
             */
            point_j?: [
                number,
                number,
                number
            ];
            /** @constant */
            type: "distance";
        } | {
            /** @description The joint. */
            joint: string;
            /** @constant */
            type: "angle";
        } | {
            /** @description The joint. */
            joint: string;
            /** @constant */
            type: "slide";
        };
        /** @description A question as a student sees it. */
        Question: {
            /** @description What a program returns for each state (implement). */
            asks?: components["schemas"]["EquationPart"][];
            /** @description True if the student has to give the unit. */
            asks_unit: boolean;
            /** @description Columns of the table besides `t` (trajectory). */
            columns?: components["schemas"]["TableColumn"][];
            /** @description Names of a vector's components in the frame that is asked for. */
            components?: string[];
            /** @description What is cut free (diagram). */
            diagram?: components["schemas"]["DiagramChoices"] | null;
            /** @description Earlier questions whose answer is carried through, right or wrong. */
            follows?: string[];
            /**
             * Format: uint
             * @description How many hints there are.
             */
            hints_available: number;
            /** @description Id under which the answer is sent. */
            id: string;
            /** @description Kind. */
            kind: components["schemas"]["QuestionKind"];
            /**
             * Format: uint
             * @description Words from which an explanation is taken (explanation).
             */
            min_words?: number | null;
            /** @description Options of a choice. */
            options?: components["schemas"]["ChoiceOption"][] | null;
            /**
             * Format: double
             * @description Points.
             */
            points: number;
            /** @description What is asked, as safe HTML. */
            prompt_html: string;
            /** @description What counts as right, in words. */
            rule: string;
            /** @description Rows and columns to fill in. */
            size?: [
                number,
                number
            ] | null;
            /** @description Symbols that a formula may use. */
            symbols?: string[];
            /** @description What may be chosen (tuning). */
            tuning?: components["schemas"]["TuningChoices"] | null;
            /** @description Unit that is assumed unless another is given; absent for choices and where the unit is asked. */
            unit?: string | null;
        };
        /** @description What the answers of a class say about a question. */
        QuestionAnalysis: {
            /**
             * Format: uint
             * @description Students with a wrong answer within three tolerances of the right one; absent where there is no tolerance.
             */
            almost?: number | null;
            /** @description How often each option was chosen; empty but for choices. */
            choices: components["schemas"]["ChoiceCount"][];
            /** @description Whether the numbers that were drawn are equally hard. */
            drawn: components["schemas"]["DrawnNumber"][];
            /** @description The figures. */
            figures: components["schemas"]["QuestionFigures"];
            /** @description Slug of the lesson. */
            lesson: string;
            /** @description Mistakes with the answers behind each, the most frequent first. */
            mistakes: components["schemas"]["MistakeAnswers"][];
            /**
             * Format: uint32
             * @description Its place in the course.
             */
            number: number;
            /**
             * Format: uint
             * @description The question's place in the lesson, from 1.
             */
            place: number;
            /** @description What is asked, with the numbers that everybody sees, as safe HTML. */
            prompt_html: string;
            /** @description Ids of the questions of the lesson, in order. */
            questions: string[];
            /**
             * Format: uint
             * @description Students with an answer that was sent back.
             */
            sent_back: number;
            /** @description Title of the lesson. */
            title: string;
        };
        /** @description A question in figures. */
        QuestionFigures: {
            /**
             * Format: uint
             * @description Of these, those who gave an answer that could be judged, or an explanation.
             */
            answered: number;
            /**
             * Format: uint
             * @description Students who handed in and were asked it.
             */
            asked: number;
            /**
             * Format: double
             * @description Correlation of first answers with those to all other questions of the lesson.
             */
            discrimination?: number | null;
            /**
             * Format: double
             * @description Mean share of the points of first answers.
             */
            facility?: number | null;
            /**
             * Format: double
             * @description Mean share of the points of best answers.
             */
            facility_best?: number | null;
            /** @description What to look at; nothing below ten students. */
            flags: components["schemas"]["Flag"][];
            /** @description The question's id. */
            id: string;
            /** @description Its kind. */
            kind: components["schemas"]["QuestionKind"];
            /** @description Mistakes by the number of students who made them, the most frequent first. An empty name: not recognised. */
            mistakes: components["schemas"]["MistakeCount"][];
            /**
             * Format: double
             * @description Its points.
             */
            points: number;
            /**
             * Format: uint
             * @description Those who earned all points by now.
             */
            right: number;
            /** @description Students who needed 1, 2, 3, 4, and 5 or more different answers. */
            until_right: [
                number,
                number,
                number,
                number,
                number
            ];
            /**
             * Format: double
             * @description Facility among the 27 % who are best at the other questions, less that among the 27 % who are worst.
             */
            upper_less_lower?: number | null;
        };
        /** @description Kind of a question. */
        QuestionKind: "number" | "vector" | "matrix" | "choice" | "formula" | "diagram" | "implement" | "trajectory" | "model" | "tuning" | "explanation";
        /** @description Where a student stands with one question after all submissions so far. */
        QuestionStanding: {
            /**
             * Format: uint
             * @description Answers that said something else than all before.
             */
            attempts: number;
            /**
             * Format: double
             * @description The best points so far; where the answer is open, the best before it opened.
             */
            best: number;
            /**
             * Format: uint
             * @description Different answers that are left until the right one is shown, where it opens by their number.
             */
            left?: number | null;
            /** @description Whether the right answer is shown. The points stay as they were before. */
            open: boolean;
        };
        /** @description What a student has reached in a lesson. */
        Reached: {
            /** @description Whether the student asks to look again. */
            asked: boolean;
            /**
             * Format: uint32
             * @description Attempts; 0 where nothing could be judged yet.
             */
            attempts: number;
            /** @description What somebody decided. */
            decided?: components["schemas"]["Decided"] | null;
            /**
             * Format: double
             * @description Most points of an attempt.
             */
            earned: number;
            /**
             * Format: double
             * @description Points that people gave for explanations.
             */
            explained: number;
            /** @description Whether there is an extension. */
            extended: boolean;
            /** @description When the last submission came; left out where nothing was handed in. */
            last?: string | null;
            /** @description Whether what counts came late. */
            late: boolean;
            /** @description Whether it is enough to pass. */
            passed: boolean;
            /**
             * Format: double
             * @description The points that count: those that were decided, else the most of an attempt.
             */
            points: number;
            /**
             * Format: double
             * @description Points for having predicted what a run would show.
             */
            predicted: number;
        };
        /** @description The reaction of a joint or driver: what body `by` does to body `on` through it — eq. (9.1). */
        Reaction: {
            /** @description The point about which the moment is taken, in words. */
            about: string;
            /** @description That point in the world, m. */
            about_at: [
                number,
                number,
                number
            ];
            /** @description Its axes x, y, z in the world: unit vectors. */
            axes: [
                [
                    number,
                    number,
                    number
                ],
                [
                    number,
                    number,
                    number
                ],
                [
                    number,
                    number,
                    number
                ]
            ];
            /** @description The body that exerts it. */
            by: string;
            /** @description Whether it is a driver. */
            driver: boolean;
            /** @description The frame of the components, in words. */
            expressed_in: string;
            /** @description Force f, N, along those axes. */
            force: [
                components["schemas"]["ReactionComponent"],
                components["schemas"]["ReactionComponent"],
                components["schemas"]["ReactionComponent"]
            ];
            /** @description The joint or driver. */
            joint: string;
            /** @description Moment τ about that point, N m, along those axes. */
            moment: [
                components["schemas"]["ReactionComponent"],
                components["schemas"]["ReactionComponent"],
                components["schemas"]["ReactionComponent"]
            ];
            /** @description The body that the reaction acts on. */
            on: string;
        };
        /** @description One component of a force or moment. */
        ReactionComponent: {
            /** @description Whether the equations of motion determine it. */
            unique: boolean;
            /**
             * Format: double
             * @description Value, N or N m; where it is not unique, that of the smallest multipliers that give the same motion.
             */
            value: number;
        };
        /** @description Every reaction at one moment, and what is not unique about them — THEORY section 9. */
        ReactionReport: {
            /**
             * Format: double
             * @description A row of unit length of which less than this is across the others depends on them.
             */
            rank_tolerance: number;
            /** @description The reactions, joints before drivers. */
            reactions: components["schemas"]["Reaction"][];
            /** @description Sets of joints that share redundant rows at this position. */
            redundancies: components["schemas"]["Redundancy"][];
            /**
             * Format: double
             * @description Time t, s.
             */
            time: number;
            /**
             * Format: double
             * @description A component that changes by less than this part of its own size is unique.
             */
            tolerance: number;
        };
        /** @description Every reaction at one moment. */
        Reactions: {
            /** @description The reactions, joints before drivers. */
            reactions: components["schemas"]["Reaction"][];
            /** @description Sets of joints that share redundant rows at this position. */
            redundancies: components["schemas"]["Redundancy"][];
            /**
             * Format: double
             * @description Time, s.
             */
            time: number;
        };
        /** @description Why somebody predicts what they do. */
        Reason: {
            /** @description The name. */
            name: string;
            /** @description The option; absent if the prediction was skipped. */
            option?: components["schemas"]["ChoiceOption"] | null;
            /** @description The sentence. */
            why: string;
        };
        /** @description One person's work. */
        Record: {
            /** @description The person's id. */
            id: string;
            /** @description The lessons in which something was handed in, decided or set, in the order of the course. */
            lessons: components["schemas"]["LessonRecord"][];
            /** @description The name. */
            name: string;
        };
        /** @description A recorded run. */
        RecordedMotion: {
            /** @description Names of the bodies, in the scene's order. */
            bodies: string[];
            /**
             * Format: double
             * @description Length of a force's arrow, m/N.
             */
            force_scale: number;
            /** @description The joints and drivers whose reactions are recorded. */
            joints: components["schemas"]["MotionJoint"][];
            /**
             * Format: double
             * @description The longest arrow, m.
             */
            longest: number;
            /**
             * Format: double
             * @description Radius of a moment's circle, m/(N m).
             */
            moment_scale: number;
            /** @description What of the scene is drawn: bodies, joints, markers, gravity. */
            scene: components["schemas"]["Scene"];
            /**
             * Format: double
             * @description Simulated seconds by second at which it is watched well.
             */
            speed: number;
            /** @description Title of the scene. */
            title: string;
            /** @description One block of the stream of numbers, as base64. */
            track: string;
            /**
             * Format: double
             * @description End of what is recorded, s.
             */
            until: number;
        };
        /**
         * @description A set of joints and drivers whose rows repeat each other.
         *
         *     ```
         *     use triad_engine::prelude::*;
         *     use triad_engine::reactions::report::Convention;
         *
         *     let report = Simulation::new(&catalogue::scene("n-four-bar:1")?)?.reactions(Convention::default())?;
         *     let set = &report.redundancies[0];
         *     assert_eq!((set.rows, set.joints.len()), (3, 4), "four hinges hold the plane three times too often");
         *     assert!(!set.remedies.is_empty());
         *     # Ok::<(), EngineError>(())
         *     ```
         */
        Redundancy: {
            /** @description The joints and drivers that share them; none of them alone is to blame. */
            joints: string[];
            /** @description Changes that together remove the redundancy and keep the mobility, if the usual ones do. */
            remedies: components["schemas"]["Remedy"][];
            /**
             * Format: uint
             * @description How many rows are too many.
             */
            rows: number;
        };
        /** @description Dependent rows of one joint. */
        RedundantRows: {
            /** @description The joint. */
            joint: string;
            /** @description Labels of its dependent rows. */
            rows: string[];
        };
        /** @description Rows of one form of which some say again what others say. */
        RedundantSet: {
            /**
             * Format: uint
             * @description How many of them are too many.
             */
            dependent: number;
            /** @description The rows, as indices. */
            rows: number[];
        };
        /** @description Regrades that were applied, the latest first. */
        RegradeList: components["schemas"]["AppliedRegrade"][];
        /** @description What a regrade changed. */
        RegradeNote: {
            /** @description When. */
            at: string;
            /** @description By whom. */
            by: string;
            /** @description The regrade. */
            id: string;
            /** @description Points before and after; left out while they are held back. */
            points?: [
                number,
                number
            ] | null;
            /** @description Why. */
            reason: string;
            /** @description When it was taken back. */
            undone?: string | null;
        };
        /** @description How far a preview is. */
        RegradeProgress: {
            /**
             * Format: uint
             * @description Submissions that were graded again.
             */
            done: number;
            /**
             * Format: uint
             * @description Submissions that are to be; 0 until they are counted.
             */
            of: number;
            /** @description Whether one is being made. */
            under_way: boolean;
        };
        /** @description Whether the results are released. */
        Release: {
            /** @description True to tell what waits for it. */
            released: boolean;
        };
        /** @description Something that was decided or said. */
        Remark: {
            /** @description When. */
            at: string;
            /** @description By whom. */
            by: string;
            /** @description `points`, `mark` of an explanation, `comment`, or `request` by the student. */
            kind: string;
            /**
             * Format: double
             * @description The points that count from then on, if it is about points and does not take a decision back.
             */
            points?: number | null;
            /** @description The explanation that a mark is about. */
            question?: string | null;
            /** @description Why, or what was said. */
            text: string;
        };
        /** @description A change of one joint. */
        Remedy: {
            /** @description What it would become. */
            becomes: components["schemas"]["JointKind"];
            /** @description What it would no longer hold, in words. */
            gives_up: string;
            /** @description The joint. */
            joint: string;
        };
        /** @description What students are told of a verdict, and when. */
        Reveal: {
            /**
             * @description What is said about wrong answers.
             * @default at_once
             */
            messages?: components["schemas"]["When"];
            /**
             * @description Points, and what is right.
             * @default at_once
             */
            points?: components["schemas"]["When"];
            /**
             * @description The right answers. At once: as the course opens them, after a right answer or so many different ones.
             * @default at_once
             */
            reference?: components["schemas"]["When"];
        };
        /** @description What of the verdicts a student is told. */
        Revealed: {
            /** @description What is said about wrong answers. */
            messages: boolean;
            /** @description Points, and what is right. */
            points: boolean;
            /** @description The right answers. */
            reference: boolean;
        };
        /** @description Settings of a run, as chosen. */
        RunSettings: {
            /** @description Baumgarte's α and β in 1/s, as typed; without them the state is projected. */
            baumgarte?: [
                components["schemas"]["TypedValue"],
                components["schemas"]["TypedValue"]
            ] | null;
            /** @description The integrator. */
            integrator: components["schemas"]["IntegratorKind"];
            /** @description Its tolerance, as typed. */
            tolerance: components["schemas"]["TypedValue"];
        };
        /** @description A mechanism, its surroundings and how to run it. */
        Scene: {
            /** @description The moving bodies. */
            bodies: components["schemas"]["Body"][];
            /** @description Coordinates of every body that does not choose for itself. */
            coordinates?: components["schemas"]["Coordinates"];
            /** @description What the scene shows and where its data come from. */
            description?: string;
            /** @description What moves as prescribed. */
            drivers?: components["schemas"]["Driver"][];
            /** @description Moments to look for. */
            events?: components["schemas"]["Event"][];
            /**
             * @description Acceleration of gravity in the world frame, m/s².
             * @default [
             *       0,
             *       0,
             *       -9.81
             *     ]
             */
            gravity?: [
                number,
                number,
                number
            ];
            /** @description The joints. */
            joints?: components["schemas"]["Joint"][];
            /** @description Forces and moments besides gravity. */
            loads?: components["schemas"]["Load"][];
            /** @description Points with names, whose places and velocities are told. */
            markers?: components["schemas"]["Marker"][];
            /** @description Short name in lower case, used in file names and addresses. */
            name: string;
            /** @description Numbers of the scene that may be changed while it runs. */
            parameters?: components["schemas"]["Parameter"][];
            /** @description How to run the scene. */
            simulation?: components["schemas"]["Settings"];
            /** @description Title for people. */
            title?: string;
        };
        /** @description Other values for numbers of the scene. */
        SceneChange: {
            /**
             * @description Values of any other numbers, by JSON pointers into the scene; also `/coordinates`, `/simulation/integrator`
             *     and `/simulation/stabilization`.
             * @default {}
             * @example {
             *       "/simulation/tolerance": 0.000001
             *     }
             */
            places?: {
                [key: string]: components["schemas"]["NumberOrWord"];
            };
            /**
             * @description What happens to the run: as the parameters say if it is not given, and a restart for other numbers.
             * @default null
             */
            then?: components["schemas"]["AfterChange"] | null;
            /**
             * @description Values of the parameters that the scene's author offers, by name.
             * @default {}
             * @example {
             *       "mass": 2.5
             *     }
             */
            values?: {
                [key: string]: number;
            };
        };
        /** @description A built-in scene. */
        SceneEntry: {
            /** @description Name to run it by. */
            name: string;
            /** @description What it is. */
            summary: string;
        };
        /** @description The built-in scenes. */
        SceneList: components["schemas"]["SceneEntry"][];
        /** @description A JSON Schema. */
        SceneSchema: {
            [key: string]: unknown;
        };
        /** @description Where a session's scene came from. */
        SceneSource: {
            lesson: string;
        } | {
            builtin: string;
        } | {
            scene: string;
        };
        /** @description The points of a person in an exercise. */
        Score: {
            /** @description What each attempt counts, the first at the beginning. */
            credits: components["schemas"]["Credit"][];
            /** @description The decision that holds. */
            decided?: components["schemas"]["Decided"] | null;
            /**
             * Format: double
             * @description Most points of an attempt, as its verdict says.
             */
            earned: number;
            /** @description Whether the attempt that counts came late. */
            late: boolean;
            /** @description Whether they are enough to pass. */
            passed: boolean;
            /**
             * Format: double
             * @description Those that count.
             */
            points: number;
        };
        /** @description An axis with its sense. */
        Sense: "+x" | "-x" | "+y" | "-y" | "+z" | "-z";
        /** @description The text messages to a watcher. */
        SessionMessage: components["schemas"]["SessionState"] | {
            /** @constant */
            type: "reset";
        } | {
            /** @constant */
            type: "closed";
        };
        /** @description A number that may be changed, as it is now. */
        SessionParameter: {
            /**
             * Format: double
             * @description Greatest value.
             */
            high: number;
            /**
             * Format: double
             * @description Its value in the scene as the author wrote it.
             */
            initial: number;
            /** @description Name for people. */
            label: string;
            /**
             * Format: double
             * @description Least value.
             */
            low: number;
            /** @description Name in requests. */
            name: string;
            /** @description What happens to the run when it changes. */
            on_change: components["schemas"]["AfterChange"];
            /** @description Where its number stands in the scene. */
            pointers: string[];
            /**
             * Format: double
             * @description Between two values of a slider.
             */
            step: number | null;
            /** @description Unit, for people. */
            unit: string | null;
            /**
             * Format: double
             * @description Its value.
             */
            value: number;
        };
        /** @description A session's scene as it is now. */
        SessionScene: {
            /** @description The same, before any change. */
            original: components["schemas"]["Scene"];
            /** @description The parameters that its author offers. */
            parameters: components["schemas"]["SessionParameter"][];
            /** @description The scene with everything written out that may be changed. */
            scene: components["schemas"]["Scene"];
        };
        /** @description A session at one moment. */
        SessionState: {
            /** @description Estimated errors of this state, where they are known. */
            accuracy?: components["schemas"]["Accuracy"] | null;
            /** @description The bodies, in the scene's order. */
            bodies: components["schemas"]["BodyState"][];
            /**
             * Format: uint64
             * @description How often the scene was changed since the session began.
             */
            changes: number;
            /** @description How forces are drawn. */
            drawing: components["schemas"]["Drawing"];
            /**
             * Format: double
             * @description End of the simulation, s.
             */
            duration: number;
            /**
             * Format: uint64
             * @description How many earlier events are left out.
             */
            earlier_events: number;
            /**
             * Format: uint64
             * @description How many earlier passages are left out.
             */
            earlier_passages: number;
            /**
             * Format: double
             * @description Energy, J.
             */
            energy: number;
            /**
             * Format: double
             * @description Energy less that of the start and the work of drivers and of loads without potential since, J.
             */
            energy_drift: number;
            /** @description Why the simulation stopped before its end; the last good state is kept. */
            error?: components["schemas"]["Problem"] | null;
            /**
             * Format: double
             * @description From when on they are not known, s.
             */
            error_unknown_from?: number | null;
            /**
             * Format: uint64
             * @description Evaluations of the equations of motion.
             */
            evaluations: number;
            /**
             * @description The latest events so far, in the order of time: at most 32. The error of their times is known up to the first change of numbers in
             *     mid-run.
             */
            events: components["schemas"]["EventOccurrence"][];
            /**
             * Format: uint64
             * @description Factorizations of a matrix.
             */
            factorizations: number;
            /** @description Whether the end was reached. */
            finished: boolean;
            /** @description Forces in joints and drivers; empty for scenes of more than 64 of them. */
            forces: components["schemas"]["JointForce"][];
            /**
             * Format: uint64
             * @description Frames recorded, and how many of them were encoded because somebody watched.
             */
            frames: number;
            /**
             * Format: uint64
             * @description See `frames`.
             */
            frames_encoded: number;
            /** @description Acceleration of gravity, m/s². */
            gravity: [
                number,
                number,
                number
            ];
            /** @description Its name in addresses. */
            id: string;
            /** @description Where to go from here. */
            links: components["schemas"]["Links"];
            /** @description What the engine found or corrected in the scene, and what speaks against the result so far. */
            notes: string[];
            /** @description The latest singular configurations passed so far, in the order of time: at most 32, and fewer where many joints take part. */
            passages: components["schemas"]["SingularConfiguration"][];
            /** @description Whether time runs. */
            playing: boolean;
            /**
             * Format: double
             * @description Largest violation of the position constraints.
             */
            position_violation: number;
            /**
             * Format: uint64
             * @description Projections onto the constraints.
             */
            projections: number;
            /** @description The spring by which a body is dragged, while it is. */
            pull: components["schemas"]["Drag"] | null;
            /** @description Generalized coordinates, in the order of the Jacobian's columns. */
            q: number[];
            /** @description Their rates. */
            q_dot: number[];
            /**
             * Format: uint64
             * @description Integrator steps rejected.
             */
            rejected: number;
            /** @description Where its scene came from. */
            source: components["schemas"]["SceneSource"];
            /**
             * Format: double
             * @description Simulated seconds a second while it plays.
             */
            speed: number;
            /**
             * Format: uint64
             * @description Integrator steps accepted.
             */
            steps: number;
            /**
             * Format: double
             * @description Time of the simulation, s.
             */
            time: number;
            /** @description Title of its scene. */
            title: string;
            /**
             * Format: double
             * @description Largest violation of the velocity constraints.
             */
            velocity_violation: number;
            /**
             * Format: uint
             * @description How many watch the stream.
             */
            watchers: number;
        };
        /** @description How to run a scene. */
        Settings: {
            /**
             * Format: double
             * @description End of the run, s.
             * @default 10
             */
            duration?: number;
            /** @description Whether the run carries an estimate of the errors of its numbers along. */
            error_estimate?: boolean;
            /**
             * Format: double
             * @description Interval of output, s.
             * @default 0.01
             */
            every?: number;
            /**
             * @description Integrator.
             * @default auto
             */
            integrator?: components["schemas"]["IntegratorKind"];
            /** @description What a table of the run holds besides the time. */
            outputs?: components["schemas"]["Output"][];
            /** @description What is left out because nothing depends on it. */
            skip?: components["schemas"]["Skip"];
            /**
             * @description What keeps the constraints satisfied.
             * @default {
             *       "kind": "projection"
             *     }
             */
            stabilization?: components["schemas"]["Stabilization"];
            /**
             * Format: double
             * @description Size of the steps, s: fixed, instead of chosen by the tolerance.
             */
            step?: number | null;
            /**
             * Format: double
             * @description Relative and absolute tolerance of the step control.
             * @default 1e-9
             */
            tolerance?: number;
        };
        /** @description An invitation that is followed. */
        Setup: {
            /** @description The name that others see. */
            name: string;
            /**
             * @description Title of the class, if it is to be named now.
             * @default null
             */
            title?: string | null;
            /** @description The secret of the link `/setup#…`. */
            token: string;
        };
        /** @description A primitive drawn in a body's frame, lengths in m. */
        Shape: {
            /** @description One end. */
            from: [
                number,
                number,
                number
            ];
            /** @constant */
            kind: "rod";
            /**
             * Format: double
             * @description Radius.
             */
            radius: number;
            /** @description The other end. */
            to: [
                number,
                number,
                number
            ];
        } | {
            /** @description Centre. */
            center: [
                number,
                number,
                number
            ];
            /** @constant */
            kind: "sphere";
            /**
             * Format: double
             * @description Radius.
             */
            radius: number;
        } | {
            /** @description Centre. */
            center: [
                number,
                number,
                number
            ];
            /** @constant */
            kind: "box";
            /** @description Full edge lengths. */
            size: [
                number,
                number,
                number
            ];
        };
        /** @description Whether a follower's question is shown. */
        ShownRemark: {
            /** @description To everybody, in place of the one before. */
            shown: boolean;
        };
        /** @description Which of the two bodies of a joint. */
        Side: "i" | "j";
        /** @description A singular configuration that a run passed. */
        SingularConfiguration: {
            /** @description Joints and drivers that take part where rows become dependent on each other. */
            joints: string[];
            /**
             * Format: double
             * @description When, s.
             */
            time: number;
        };
        /**
         * @description What is left out because nothing depends on it. Every word is true unless it is switched off; then the run takes
         *     longer and gives the same motion. `triad run --explain` tells what each word saved.
         */
        Skip: {
            /**
             * @description Products of series in rows that keep a vector along an axis, which are solved as those of a common vector (integrator `taylor`).
             * @default true
             */
            axes?: boolean;
            /**
             * @description Measuring the constraints after a step whose projection has just shown that they hold (integrator `taylor`).
             * @default true
             */
            checks?: boolean;
            /**
             * @description Entries of the matrix that never change: they are written once (integrator `taylor`).
             * @default true
             */
            constants?: boolean;
            /**
             * @description Bodies that rigid connections tie to the ground, or to another body that then moves for both, and rows that hold a body in a
             *     point of the ground (integrator `taylor`).
             * @default true
             */
            fixed?: boolean;
            /**
             * @description Steps that bodies need not take with others that nothing connects them with (integrator `taylor`).
             * @default true
             */
            islands?: boolean;
            /**
             * @description Steps that end at each output: outputs are read off the polynomials of the steps.
             * @default true
             */
            outputs?: boolean;
            /**
             * @description Coordinates and rows out of the plane, where joints hold all bodies in a plane (integrator `taylor`).
             * @default true
             */
            planar?: boolean;
            /**
             * @description Energy, reactions and the Jacobian of every step: they are found when somebody asks.
             * @default true
             */
            reports?: boolean;
        };
        /** @description Somebody of the class. */
        Somebody: {
            /** @description The person's id. */
            id: string;
            /** @description The name. */
            name: string;
            /** @description `student`, `grader`, `instructor` or `owner`. */
            role: string;
        };
        /** @description What keeps the constraints satisfied during a run. */
        Stabilization: {
            /** @constant */
            kind: "projection";
        } | {
            /**
             * Format: double
             * @description α, 1/s.
             */
            alpha: number;
            /**
             * Format: double
             * @description β, 1/s.
             */
            beta: number;
            /** @constant */
            kind: "baumgarte";
        } | {
            /** @constant */
            kind: "partitioning";
        } | {
            /**
             * Format: double
             * @description α, kg: the mass that each row has against its violation, an absolute number and not one relative to the mechanism.
             *     Violations shrink with 1/α; for mechanisms of grams choose it a thousand times smaller.
             * @default 10000000
             */
            alpha?: number;
            /** @constant */
            kind: "penalty";
            /**
             * Format: double
             * @description μ, 1 for critical damping.
             * @default 1
             */
            mu?: number;
            /**
             * Format: double
             * @description Ω, rad/s.
             * @default 10
             */
            omega?: number;
        } | {
            /**
             * Format: double
             * @description α, N/m: the penalty with which the multipliers are augmented.
             * @default 1000000000
             */
            alpha?: number;
            /** @constant */
            kind: "augmented-lagrangian";
        };
        /** @description Where a person stands in an exercise. */
        Standing: {
            /**
             * Format: uint32
             * @description Attempts that were made.
             */
            attempts: number;
            /**
             * Format: uint32
             * @description Attempts that are left.
             */
            attempts_left?: number | null;
            /** @description Until when this person can hand in. */
            closes?: string | null;
            /** @description What each attempt counts, the first at the beginning. */
            credits: components["schemas"]["Credit"][];
            /** @description The decision that holds. */
            decided?: components["schemas"]["Decided"] | null;
            /** @description Until when it counts in full for this person. */
            due?: string | null;
            /**
             * Format: double
             * @description Most points of an attempt, as its verdict says.
             */
            earned: number;
            /** @description When the last submission came. */
            last?: string | null;
            /** @description Whether the attempt that counts came late. */
            late: boolean;
            /** @description From when the next attempt can be made, where one has to wait. */
            next_attempt?: string | null;
            /** @description Whether they are enough to pass. */
            passed: boolean;
            /** @description Whether it can be handed in. */
            phase: components["schemas"]["Phase"];
            /**
             * Format: double
             * @description Those that count.
             */
            points: number;
            /** @description What the student is told. */
            revealed: components["schemas"]["Revealed"];
            /**
             * Format: double
             * @description What share of its points an attempt would count now.
             */
            worth: number;
        };
        /** @description A motion in which all bodies keep their places in a frame that turns and slides uniformly. */
        SteadyMotion: {
            /** @description Velocity of the frame at the world's origin at the start, m/s. */
            sliding: [
                number,
                number,
                number
            ];
            /** @description Bodies that spin in it about an axis around which they are alike, and how fast, rad/s. */
            spins: components["schemas"]["BodySpin"][];
            /** @description Angular velocity of the frame, rad/s. */
            turning: [
                number,
                number,
                number
            ];
        };
        /** @description The four steps of a lesson. */
        StepKind: "predict" | "run" | "check" | "explain";
        /** @description How far to step: `steps` of the integrator or simulated `seconds`; one step if neither is given. */
        StepRequest: {
            /**
             * Format: double
             * @description Simulated seconds, above 0.
             */
            seconds?: number | null;
            /**
             * Format: uint32
             * @description Integrator steps, 1 to 100000.
             */
            steps?: number | null;
        };
        /** @description Somebody who is stuck. */
        Stuck: {
            /** @description When the last one came. */
            at: string;
            /** @description Slug of the lesson. */
            lesson: string;
            /** @description The mistake of the last one, if it was recognised. */
            mistake?: string | null;
            /** @description The name. */
            name: string;
            /** @description The person's id. */
            person: string;
            /** @description Id of the question. */
            question: string;
            /** @description Title of the lesson. */
            title: string;
            /**
             * Format: uint
             * @description Different wrong answers of late, and answers that were sent back.
             */
            tries: number;
        };
        /** @description What one student explained. */
        StudentExplanation: {
            /** @description When it came. */
            at: string;
            /** @description What it was given; absent where it waits. */
            mark?: components["schemas"]["Marked"] | null;
            /** @description Id of the question. */
            question: string;
            /** @description Whether the words were written after they were given points: they wait once more. */
            renewed: boolean;
            /** @description The submission. */
            submission: string;
            /** @description The words. */
            text: string;
        };
        /** @description What one student predicted. */
        StudentPrediction: {
            /** @description Id of the option; absent if it was skipped. */
            choice?: string | null;
            /** @description Id of the prediction. */
            prediction: string;
            /** @description Why, in the student's words; may be empty. */
            why: string;
        };
        /** @description A student's row. */
        StudentRow: {
            /** @description The person's id. */
            id: string;
            /** @description What they reached, by slug; a lesson in which nothing was handed in or decided is left out. */
            lessons: {
                [key: string]: components["schemas"]["Reached"];
            };
            /** @description The name. */
            name: string;
        };
        /** @description What one student said. */
        StudentWords: {
            /** @description What they explained: of each question the last. */
            explained: components["schemas"]["StudentExplanation"][];
            /** @description The name. */
            name: string;
            /** @description The person's id. */
            person: string;
            /** @description What they predicted, in the order in which they did. */
            predicted: components["schemas"]["StudentPrediction"][];
        };
        /** @description A student's answers to the questions of one lesson. */
        Submission: {
            /** @description The answers by the question's id. A question that is left out is blank. */
            answers: {
                [key: string]: components["schemas"]["Answer"];
            };
            /** @description The numbers that were asked about, if not the student's own: the seed of the lesson as it was shown. */
            seed?: string | null;
            /** @description Who answers; any name the class agrees on. */
            student?: string | null;
        };
        /** @description What changes for a submission. */
        SubmissionChange: {
            /**
             * Format: double
             * @description Points after; left out where it cannot be graded.
             */
            after?: number | null;
            /** @description When it came. */
            at: string;
            /**
             * Format: double
             * @description Points of its verdict before.
             */
            before: number;
            /** @description How it comes out. */
            changed: components["schemas"]["Changed"];
            /** @description The submission. */
            id: string;
            /** @description Misconceptions by question, where another one is recognised: before and after, empty for none. */
            misconceptions: {
                [key: string]: [
                    string,
                    string
                ];
            };
            /** @description What this program says otherwise with the lesson of before. */
            program?: string | null;
        };
        /** @description Submissions, newest first. */
        SubmissionList: components["schemas"]["KeptSubmission"][];
        /** @description A submission that has no verdict yet, or has one by now. */
        SubmissionState: {
            /**
             * Format: int64
             * @description How many come before it.
             */
            before?: number | null;
            /** @description Its name. */
            id: string;
            /** @description `waiting`, `graded`, or `failed`: it could not be graded, which is not the student's fault and uses no attempt. */
            state: string;
            /** @description What it earned. */
            verdict?: components["schemas"]["GradedSubmission"] | null;
        };
        /** @description A symmetric matrix: what stands on and below its diagonal. */
        SymmetricMatrix: {
            /**
             * Format: uint
             * @description Places on or below the diagonal that a factorization fills.
             */
            fill: number;
            /** @description What each row is, and each column alike. */
            names: string[];
            /** @description Row, column, value, and what it is: `own`, `constant`, `changing` or `fill`. */
            places: [
                number,
                number,
                number,
                components["schemas"]["MatrixPart"]
            ][];
            /**
             * Format: double
             * @description Time, s.
             */
            time: number;
        };
        /** @description A column of a table. */
        TableColumn: {
            /** @description Its name in the first line. */
            name: string;
            /** @description What it holds. */
            what: string;
        };
        /** @description A scene to run, and what to write of it. */
        TableRequest: {
            /**
             * Format: double
             * @description Time between rows, s, instead of the scene's.
             */
            every?: number | null;
            /**
             * @description The columns, instead of those that the scene chooses.
             * @default []
             */
            outputs?: components["schemas"]["Output"][];
            /** @description The scene; its schema is at /api/v1/schema/scene. */
            scene: components["schemas"]["Scene"];
            /**
             * Format: double
             * @description End of the run, s, instead of the scene's.
             */
            until?: number | null;
        };
        /** @description How many people were taken over. */
        Taken: {
            /**
             * Format: uint
             * @description People whom the platform lists.
             */
            listed: number;
            /**
             * Format: uint
             * @description Those who were not in the class before.
             */
            new: number;
        };
        /** @description How the answers stand. */
        Tally: {
            /** @description Answers for each choice when it was asked before, if this is a second vote. */
            before?: number[] | null;
            /** @description Answers for each choice. */
            counts: number[];
            /**
             * Format: uint64
             * @description The question's number.
             */
            number: number;
            /** @description Whether the answer is open to everybody. */
            revealed: boolean;
            /**
             * Format: uint
             * @description The choice that is right.
             */
            right: number | null;
        };
        /** @description The outcome for one question, without what is held back. */
        ToldQuestion: {
            /**
             * Format: double
             * @description Points earned; left out while they are held back.
             */
            earned?: number | null;
            /** @description A picture of what was computed, as SVG that the grader drew. */
            figure_svg?: string | null;
            /** @description The question's id. */
            id: string;
            /** @description What somebody who teaches gave an explanation; left out where it waits. */
            mark?: components["schemas"]["Marked"] | null;
            /** @description Feedback for the student, as safe HTML. */
            message_html?: string | null;
            /**
             * Format: double
             * @description Points that can be earned here: none where people give them.
             */
            possible: number;
            /** @description The right answer and its source, as safe HTML, where it is open. */
            reference_html?: string | null;
            /** @description The misconception that was recognised; for statistics and for the checks of authors. */
            slip?: string | null;
            /** @description What earlier submissions decide, where they are known. */
            standing?: components["schemas"]["QuestionStanding"] | null;
            /** @description Right, wrong, blank, invalid, kept for people to judge, or waiting for an answer that is invalid; left out while it is held back. */
            verdict?: components["schemas"]["Mark"] | null;
        };
        /** @description Where a person stands, without what is held back from them. */
        ToldStanding: {
            /**
             * Format: uint32
             * @description Attempts that were made.
             */
            attempts: number;
            /**
             * Format: uint32
             * @description Attempts that are left.
             */
            attempts_left?: number | null;
            /** @description Until when this person can hand in. */
            closes?: string | null;
            /** @description Until when it counts in full for this person. */
            due?: string | null;
            /** @description From when the next attempt can be made, where one has to wait. */
            next_attempt?: string | null;
            /** @description Whether it can be handed in. */
            phase: components["schemas"]["Phase"];
            /** @description The points; left out while they are held back. */
            points?: components["schemas"]["Score"] | null;
            /** @description What the student is told. */
            revealed: components["schemas"]["Revealed"];
            /**
             * Format: double
             * @description What share of its points an attempt would count now.
             */
            worth: number;
        };
        /** @description What may be chosen for a run. */
        TuningChoices: {
            /** @description Whether Baumgarte's stabilization may be chosen. */
            baumgarte: boolean;
            /**
             * Format: uint64
             * @description Evaluations that may be spent.
             */
            budget: number;
            /**
             * Format: double
             * @description The error to reach.
             */
            error: number;
            /** @description Integrators. */
            integrators: components["schemas"]["IntegratorKind"][];
        };
        /** @description A body that can turn without inertia. */
        TurnsWithoutInertia: {
            /** @description Axes about which it can turn without moving anything that has inertia, unit vectors in the world's axes. */
            axes: [
                number,
                number,
                number
            ][];
            /** @description The body. */
            body: string;
        };
        /** @description An answer to read. */
        TypedAnswer: {
            /**
             * @description The unit of the value, as typed.
             * @default null
             */
            unit?: string | null;
            /** @description A number, a list of numbers, or a formula, as typed. */
            value: components["schemas"]["TypedValue"];
        };
        /** @description A value as typed: text keeps the digits that were written, a JSON number is taken as its shortest text. */
        TypedValue: string | number | unknown[];
        /** @description How a typed answer is understood. */
        Understood: {
            /** @description The entries of a vector or a matrix that stood in one text, row by row. */
            cells?: string[];
            /** @description What to change so that it can be read. */
            problem?: string | null;
            /** @description The answer as it is read: `29.4 N`, `(1, 2, 3) kg m/s`, `m·g·cos(alpha)`. */
            text?: string | null;
        };
        /** @description A robot to be imported. */
        UrdfImport: {
            /** @description The text of the URDF. */
            urdf: string;
            /** @description What it does not say: joints that close loops, positions at the start, drivers, loads, settings. */
            with?: components["schemas"]["UrdfSupplement"];
        };
        /** @description What the root link is. */
        UrdfRoot: "ground" | "free";
        /** @description What a URDF does not say. */
        UrdfSupplement: {
            /**
             * @description What moves as prescribed.
             * @default []
             */
            drivers?: components["schemas"]["Driver"][];
            /**
             * @description Acceleration of gravity, m/s².
             * @default null
             */
            gravity?: [
                number,
                number,
                number
            ] | null;
            /**
             * @description Joints that close loops; bodies are links, points and axes are given in their frames.
             * @default []
             */
            joints?: components["schemas"]["Joint"][];
            /**
             * @description Forces and moments.
             * @default []
             */
            loads?: components["schemas"]["Load"][];
            /**
             * @description Positions of joints at the start, by name, from the robot's zero, from which drivers, springs, events and tables count as well:
             *     rad or m. One that follows another by `<mimic>` needs none.
             * @default {}
             */
            positions?: {
                [key: string]: number;
            };
            /** @description Whether the root link is the ground or moves freely. */
            root?: components["schemas"]["UrdfRoot"];
            /**
             * @description How to run the scene.
             * @default {
             *       "duration": 10,
             *       "every": 0.01,
             *       "integrator": "auto",
             *       "stabilization": {
             *         "kind": "projection"
             *       },
             *       "tolerance": 1e-9
             *     }
             */
            simulation?: components["schemas"]["Settings"];
            /**
             * @description Velocities of joints at the start, by name: rad/s or m/s.
             * @default {}
             */
            velocities?: {
                [key: string]: number;
            };
        };
        /** @description A vector as a function of time: one of the kinds of motion, or three plain numbers, which are constant. */
        VectorMotion: {
            /** @constant */
            kind: "fixed";
            /** @description The vector. */
            vector: [
                number,
                number,
                number
            ];
        } | {
            /** @constant */
            kind: "components";
            /** @description First component. */
            x: components["schemas"]["Motion"];
            /** @description Second component. */
            y: components["schemas"]["Motion"];
            /** @description Third component. */
            z: components["schemas"]["Motion"];
        } | {
            /** @description The angle, rad. */
            angle: components["schemas"]["Motion"];
            /** @description The axis; made a unit vector. */
            axis: [
                number,
                number,
                number
            ];
            /** @constant */
            kind: "turning";
            /** @description The vector where the angle is zero. */
            start: [
                number,
                number,
                number
            ];
        } | [
            number,
            number,
            number
        ];
        /** @description Every verdict of a submission, the first at the beginning. */
        VerdictList: components["schemas"]["GivenVerdict"][];
        /** @description A follower's answer. */
        Vote: {
            /**
             * Format: uint
             * @description The choice, as an index.
             */
            choice: number;
            /**
             * Format: uint64
             * @description The question's number.
             */
            question: number;
            /** @description A name that the follower's browser made up: the same voter votes anew, not twice. */
            voter: string;
        };
        /** @description Where the browser goes next. */
        WayOut: {
            /** @description An address of the institution's provider, where its page is shown. */
            to: string;
        };
        /** @description What somebody needs to come back on another device; it is told once. */
        Welcome: {
            /** @description The secret of the link `/return#…`, for whoever prefers a bookmark. */
            link: string;
            /** @description Who came in. */
            person: components["schemas"]["Somebody"];
            /** @description Four words, to be written down. */
            words: string;
        };
        /** @description When something is told. */
        When: "at_once" | "after_due" | "when_released" | "never";
        /** @description Something that is said about work in a lesson. */
        Words: {
            /** @description Slug of the lesson. */
            lesson: string;
            /** @description What. */
            text: string;
        };
    };
    responses: never;
    parameters: never;
    requestBodies: never;
    headers: never;
    pathItems: never;
}
export type $defs = Record<string, never>;
export type operations = Record<string, never>;
